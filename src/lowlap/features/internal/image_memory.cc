#include "lowlap/features/internal/image_memory.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <opencv2/core.hpp>

namespace lowlap {
namespace {

constexpr std::size_t kMinBytes = std::size_t{1} << 18;

class ReusingAllocator : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* given,
                         std::size_t* step, cv::AccessFlag access,
                         cv::UMatUsageFlags usage) const override {
    std::size_t bytes = CV_ELEM_SIZE(type);
    for (int i = 0; i < dims; ++i) bytes *= static_cast<std::size_t>(sizes[i]);
    if (given != nullptr || bytes < kMinBytes) {
      return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, given,
                                                  step, access, usage);
    }
    if (step != nullptr) {
      std::size_t total = CV_ELEM_SIZE(type);
      for (int i = dims - 1; i >= 0; --i) {
        step[i] = total;
        total *= static_cast<std::size_t>(sizes[i]);
      }
    }
    auto* block = new cv::UMatData(this);
    block->size = bytes;
    try {
      block->data = block->origdata = Take(bytes);
    } catch (...) {
      delete block;
      throw;
    }
    return block;
  }

  bool allocate(cv::UMatData* block, cv::AccessFlag,
                cv::UMatUsageFlags) const override {
    return block != nullptr;
  }

  void deallocate(cv::UMatData* block) const override {
    if (block == nullptr) return;
    Give(block->origdata, block->size);
    block->origdata = nullptr;
    delete block;
  }

  void Open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (num_holders_++ > 0) return;
    before_ = cv::Mat::getDefaultAllocator();
    cv::Mat::setDefaultAllocator(this);
  }

  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--num_holders_ > 0) return;
    cv::Mat::setDefaultAllocator(before_);
    while (!kept_.empty()) DropLargest();
    most_used_ = used_;
  }

 private:
  unsigned char* Take(std::size_t bytes) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    used_ += bytes;
    most_used_ = std::max(most_used_, used_);
    const auto fit = kept_.find(bytes);
    if (fit != kept_.end()) {
      unsigned char* memory = fit->second;
      kept_bytes_ -= bytes;
      kept_.erase(fit);
      return memory;
    }
    while (!kept_.empty() && used_ + kept_bytes_ > most_used_) DropLargest();
    try {
      return static_cast<unsigned char*>(cv::fastMalloc(bytes));
    } catch (...) {
      used_ -= bytes;
      throw;
    }
  }

  void Give(unsigned char* memory, std::size_t bytes) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    used_ -= bytes;
    if (num_holders_ > 0) {
      try {
        kept_.emplace(bytes, memory);
        kept_bytes_ += bytes;
        return;
      } catch (const std::bad_alloc&) {
        // No memory to remember it in; destructors of matrices come here.
      }
    }
    cv::fastFree(memory);
  }

  void DropLargest() const {
    const auto largest = std::prev(kept_.end());
    cv::fastFree(largest->second);
    kept_bytes_ -= largest->first;
    kept_.erase(largest);
  }

  mutable std::mutex mutex_;
  mutable std::multimap<std::size_t, unsigned char*> kept_;  // by size
  mutable std::size_t kept_bytes_ = 0;
  mutable std::size_t used_ = 0;
  mutable std::size_t most_used_ = 0;
  int num_holders_ = 0;
  cv::MatAllocator* before_ = nullptr;
};

// Never destroyed: matrices may outlive every holder.
ReusingAllocator& Allocator() {
  static auto* allocator = new ReusingAllocator;
  return *allocator;
}

}  // namespace

ReusedImageMemory::ReusedImageMemory() { Allocator().Open(); }

ReusedImageMemory::~ReusedImageMemory() { Allocator().Close(); }

}  // namespace lowlap
