#include "lowlap/core/internal/graph_blocks.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lowlap {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

class BlockFinder {
 public:
  explicit BlockFinder(const std::vector<std::vector<std::size_t>>& neighbors)
      : neighbors_(neighbors),
        order_(neighbors.size(), kNone),
        low_(neighbors.size(), 0) {}

  std::vector<std::vector<std::size_t>> Find() {
    for (std::size_t root = 0; root < neighbors_.size(); ++root) {
      if (order_[root] == kNone) Walk(root);
    }
    return std::move(blocks_);
  }

 private:
  struct Step {
    std::size_t node, parent, next;
  };

  void Enter(std::size_t node, std::size_t parent) {
    order_[node] = low_[node] = count_++;
    seen_.push_back(node);
    open_.push_back({node, parent, 0});
  }

  void Walk(std::size_t root) {
    Enter(root, kNone);
    while (!open_.empty()) {
      Step& step = open_.back();
      const std::size_t node = step.node, parent = step.parent;
      if (step.next < neighbors_[node].size()) {
        const std::size_t other = neighbors_[node][step.next++];
        if (other == parent) continue;
        if (order_[other] == kNone) {
          Enter(other, node);
        } else {
          low_[node] = std::min(low_[node], order_[other]);
        }
        continue;
      }
      open_.pop_back();
      if (parent == kNone) continue;
      low_[parent] = std::min(low_[parent], low_[node]);
      if (low_[node] >= order_[parent]) Close(node, parent);
    }
    seen_.clear();
  }

  // Everything entered since `node`, and `parent`, are one block.
  void Close(std::size_t node, std::size_t parent) {
    const auto first = std::find(seen_.rbegin(), seen_.rend(), node).base() - 1;
    std::vector<std::size_t> block(first, seen_.end());
    block.push_back(parent);
    seen_.erase(first, seen_.end());
    std::sort(block.begin(), block.end());
    blocks_.push_back(std::move(block));
  }

  const std::vector<std::vector<std::size_t>>& neighbors_;
  std::vector<std::size_t> order_, low_, seen_;
  std::vector<Step> open_;
  std::size_t count_ = 0;
  std::vector<std::vector<std::size_t>> blocks_;
};

}  // namespace

std::vector<std::vector<std::size_t>> FindBlocks(
    const std::vector<std::vector<std::size_t>>& neighbors) {
  return BlockFinder(neighbors).Find();
}

}  // namespace lowlap
