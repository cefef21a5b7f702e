#include "lowlap/features/internal/opencv.h"

#include <gtest/gtest.h>

#include <new>

#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;

TEST(SingleThreadedOpenCv, TheLastHolderRestoresTheNumberOfThreads) {
  const int before = cv::getNumThreads();
  cv::setNumThreads(3);
  {
    const SingleThreadedOpenCv outer;
    EXPECT_EQ(cv::getNumThreads(), 1);
    { const SingleThreadedOpenCv inner; }
    EXPECT_EQ(cv::getNumThreads(), 1);
  }
  EXPECT_EQ(cv::getNumThreads(), 3);
  cv::setNumThreads(before);
}

TEST(CatchOpenCv, ExceptionsOfOpenCvBecomeErrors) {
  const Status status = CatchOpenCv("sum", []() -> Status {
    const cv::Mat sum = cv::Mat::ones(2, 2, CV_8U) + cv::Mat::ones(3, 3, CV_8U);
    return {};
  });
  EXPECT_THAT(status, IsError(ErrorCode::kNumerical, "sum: OpenCV"));
}

TEST(ReadWithOpenCv, ExceptionsBecomeErrorsOfTheFile) {
  const Status status = ReadWithOpenCv("a.bmp", []() -> Status {
    CV_Error(cv::Error::StsAssert, "size.height");
  });
  ASSERT_THAT(status, IsError(ErrorCode::kParse, "size.height"));
  EXPECT_EQ(status.error().file, "a.bmp");
}

// It is no error of the image: who runs the stage says so.
TEST(CatchOpenCv, MemoryThatCannotBeHadStaysAnException) {
  EXPECT_THROW(CatchOpenCv("image", []() -> Status { throw std::bad_alloc(); }),
               std::bad_alloc);
  EXPECT_THROW(CatchOpenCv("image",
                           []() -> Status {
                             throw cv::Exception(cv::Error::StsNoMem, "", "",
                                                 "", 0);
                           }),
               std::bad_alloc);
}

}  // namespace
}  // namespace lowlap
