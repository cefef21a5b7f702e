#include "third_party_adapters/strecha/internal/strecha.h"

#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/token_reader.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap::strecha {
namespace {

namespace fs = std::filesystem;

/// Exactly `count` finite numbers, separated by white space.
Result<std::vector<double>> ParseNumbers(std::string_view text,
                                         std::size_t count,
                                         const std::string& file) {
  TokenReader reader(text, file);
  std::vector<double> numbers;
  while (reader.status() && !reader.AtEnd()) {
    if (numbers.size() == count) {
      reader.Fail("more than " + std::to_string(count) + " numbers");
    }
    numbers.push_back(reader.Next<double>("a finite number"));
  }
  if (!reader.status()) return reader.error();
  if (numbers.size() < count) {
    return MakeError(ErrorCode::kParse,
                     std::to_string(count) + " numbers are expected, not " +
                         std::to_string(numbers.size()),
                     file);
  }
  return numbers;
}

Mat3 MatrixFromRows(const double* values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values);
}

Status CheckCalibration(const Mat3& k, const std::string& file) {
  if (k(0, 1) != 0 || k(1, 0) != 0) {
    return MakeError(ErrorCode::kUnsupported,
                     "the calibration matrix has skew, which no camera model "
                     "here holds",
                     file, "row 1 or 2");
  }
  if (k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1) {
    return MakeError(ErrorCode::kUnsupported,
                     "the last row of a calibration matrix is 0 0 1", file,
                     "row 3");
  }
  if (!(k(0, 0) > 0 && k(1, 1) > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "focal lengths must be positive", file);
  }
  return {};
}

// What programs put about the numbers of a matrix: a byte-order mark, comments,
// commas, semicolons, brackets.
std::string WithoutPunctuation(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::string numbers;
  bool is_comment = false;
  for (const char c : text) {
    is_comment = c == '#' || (is_comment && c != '\n');
    const bool is_number =
        !is_comment && c != ',' && c != ';' && c != '[' && c != ']';
    numbers += is_number ? c : ' ';
  }
  return numbers;
}

bool IsImageSize(double value) {
  return value >= 1 && value <= 1e6 && value == std::floor(value);
}

}  // namespace

Result<Mat3> ParseCalibrationMatrix(std::string_view text,
                                    const std::string& file) {
  auto numbers = ParseNumbers(WithoutPunctuation(text), 9, file);
  if (!numbers) {
    numbers.error().message +=
        "; a matrix fx 0 cx / 0 fy cy / 0 0 1 is expected (with distortion: a "
        "scene, or a COLMAP model's folder)";
    return tl::unexpected<Error>(numbers.error());
  }
  const Mat3 calibration = MatrixFromRows(numbers->data());
  LOWLAP_RETURN_IF_ERROR(CheckCalibration(calibration, file));
  return calibration;
}

Result<Mat3> ReadCalibrationMatrix(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  return ParseCalibrationMatrix(text, path);
}

Intrinsic PinholeFromMatrix(const Mat3& calibration, int width_px,
                            int height_px) {
  Intrinsic intrinsic;
  intrinsic.width_px = width_px;
  intrinsic.height_px = height_px;
  intrinsic.fx_px = calibration(0, 0);
  intrinsic.fy_px = calibration(1, 1);
  intrinsic.principal_point_px = calibration.block<2, 1>(0, 2);
  return intrinsic;
}

Result<Camera> ParseCamera(std::string_view text, const std::string& file) {
  LOWLAP_ASSIGN_OR_RETURN(const std::vector<double> parsed,
                          ParseNumbers(text, 26, file));
  const double* numbers = parsed.data();
  const Mat3 calibration = MatrixFromRows(numbers);
  LOWLAP_RETURN_IF_ERROR(CheckCalibration(calibration, file));
  if (numbers[9] != 0 || numbers[10] != 0 || numbers[11] != 0) {
    return MakeError(ErrorCode::kUnsupported,
                     "0 0 0 is expected after the calibration matrix", file);
  }
  const Mat3 world_from_cam = MatrixFromRows(numbers + 12);
  if (!(RotationDefect(world_from_cam) <= 1e-3)) {
    return MakeError(ErrorCode::kParse, "the rotation is no rotation matrix",
                     file);
  }
  if (!IsImageSize(numbers[24]) || !IsImageSize(numbers[25])) {
    return MakeError(ErrorCode::kParse,
                     "the last two numbers are no image size", file);
  }
  Camera camera;
  camera.intrinsic =
      PinholeFromMatrix(calibration, static_cast<int>(numbers[24]),
                        static_cast<int>(numbers[25]));
  camera.pose.rotation = NearestRotation(world_from_cam.transpose());
  camera.pose.center = Vec3(numbers[21], numbers[22], numbers[23]);
  return camera;
}

Result<Camera> ReadCamera(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  return ParseCamera(text, path);
}

Result<std::map<std::string, Camera>> ReadCameras(const std::string& dir) {
  const std::string extension = ".camera";
  fs::path folder = dir;
  std::error_code error;
  if (fs::is_directory(folder / "gt_dense_cameras", error)) {
    folder /= "gt_dense_cameras";
  }
  std::map<std::string, Camera> cameras;
  fs::directory_iterator entry(folder, error);
  if (error) {
    const bool is_missing = error == std::errc::no_such_file_or_directory ||
                            error == std::errc::not_a_directory;
    return MakeError(
        is_missing ? ErrorCode::kNotFound : ErrorCode::kIo,
        is_missing ? "no such folder" : "cannot be opened: " + error.message(),
        folder.string());
  }
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != extension) continue;
    LOWLAP_ASSIGN_OR_RETURN(Camera camera, ReadCamera(entry->path().string()));
    cameras.emplace(entry->path().stem().string(), std::move(camera));
  }
  if (error) {
    return MakeError(ErrorCode::kIo, error.message(), folder.string());
  }
  if (cameras.empty()) {
    return MakeError(ErrorCode::kNotFound, "the folder holds no .camera file",
                     folder.string());
  }
  return cameras;
}

Result<std::map<std::string, Pose>> ReadGroundTruth(const std::string& dir) {
  LOWLAP_ASSIGN_OR_RETURN(const auto cameras, ReadCameras(dir));
  std::map<std::string, Pose> poses;
  for (const auto& [name, camera] : cameras) poses.emplace(name, camera.pose);
  return poses;
}

}  // namespace lowlap::strecha
