#pragma once

namespace lowlap {

/// While one lives, the large blocks of memory that image processing frees are
/// kept for the next image instead of going back to the system, which would
/// hand out each page anew. Never more is
/// held than has been in use at once. OpenCV's default allocator is replaced
/// for the time, which is global to the process: the last holder restores what
/// the first one found.
class ReusedImageMemory {
 public:
  ReusedImageMemory();
  ~ReusedImageMemory();
  ReusedImageMemory(const ReusedImageMemory&) = delete;
  ReusedImageMemory& operator=(const ReusedImageMemory&) = delete;
};

}  // namespace lowlap
