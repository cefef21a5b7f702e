#include "lowlap/features/internal/image_memory.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace lowlap {
namespace {

TEST(ReusedImageMemory, RestoresTheAllocatorWithTheLastHolder) {
  cv::MatAllocator* before = cv::Mat::getDefaultAllocator();
  {
    const ReusedImageMemory outer;
    EXPECT_NE(cv::Mat::getDefaultAllocator(), before);
    { const ReusedImageMemory inner; }
    EXPECT_NE(cv::Mat::getDefaultAllocator(), before);
  }
  EXPECT_EQ(cv::Mat::getDefaultAllocator(), before);
}

TEST(ReusedImageMemory, GivesABlockOfTheSameSizeAgain) {
  const ReusedImageMemory reused;
  const uchar* first = nullptr;
  {
    cv::Mat image(1024, 1024, CV_32F, cv::Scalar(1));
    first = image.data;
    EXPECT_EQ(image.step[0], 4096u);
  }
  const cv::Mat again(1024, 1024, CV_32F);
  EXPECT_EQ(again.data, first);
}

TEST(ReusedImageMemory, MayBeOutlivedByAnImage) {
  cv::Mat image;
  {
    const ReusedImageMemory reused;
    image = cv::Mat(1024, 1024, CV_32F, cv::Scalar(3));
  }
  EXPECT_EQ(image.at<float>(1023, 1023), 3);
}

}  // namespace
}  // namespace lowlap
