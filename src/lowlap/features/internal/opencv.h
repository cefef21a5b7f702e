#pragma once

#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"

namespace lowlap {

/// A view of the image's pixels, not a copy; OpenCV has no const matrix, so
/// the caller must not write to it.
inline cv::Mat AsMat(const GrayImage& image) {
  return cv::Mat(image.height, image.width, CV_8UC1,
                 const_cast<std::uint8_t*>(image.pixels.data()));
}

/// The pixels of an image file as stored, whatever orientation it asks for.
/// `flags` are those of cv::imdecode; what OpenCV throws goes on.
Result<cv::Mat> DecodeAsStored(const std::string& bytes, int flags,
                               const std::string& path);

/// Holds OpenCV to the calling thread while it lives. Images are processed in
/// parallel by their caller, who was told how many threads it may use; OpenCV
/// would start its own. The setting is global to the process: the last holder
/// restores what the first one found.
class SingleThreadedOpenCv {
 public:
  SingleThreadedOpenCv();
  ~SingleThreadedOpenCv();
  SingleThreadedOpenCv(const SingleThreadedOpenCv&) = delete;
  SingleThreadedOpenCv& operator=(const SingleThreadedOpenCv&) = delete;
};

/// Runs a function that returns a Result and may throw out of OpenCV; such an
/// exception becomes an error, unless memory ran out: std::bad_alloc.
template <class Function>
auto CatchOpenCv(const std::string& what, Function&& function)
    -> decltype(function()) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) throw std::bad_alloc();
    return MakeError(ErrorCode::kNumerical, what + ": " + e.what());
  } catch (const std::exception& e) {
    return MakeError(ErrorCode::kNumerical, what + ": " + e.what());
  }
}

/// The same for what is decoded from a file, which the error names: kParse.
template <class Function>
auto ReadWithOpenCv(const std::string& path, Function&& function)
    -> decltype(function()) {
  auto result = CatchOpenCv("cannot be read", std::forward<Function>(function));
  if (!result) {
    result.error() = {ErrorCode::kParse, result.error().message, path, {}};
  }
  return result;
}

}  // namespace lowlap
