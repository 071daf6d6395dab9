// Poses of a map, solved and measured.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <Eigen/Geometry>

#include "reach/best_rows.hpp"
#include "reach/pose_block.hpp"

namespace ikgen_runtime {

// Per pose its number of rows, 255 at most, and what the best of them measure. Arm: as for BestRows; Solutions; solve_batch,
// which is told poses, how many, and where their solutions go.
template <class Arm> class SolvedBlock {
 public:
  explicit SolvedBlock(const PoseBlock& block)
      : counts_(block.count()), singular_values_(block.count()), margins_(block.count()) {
    BestRows<Arm> best(singular_values_.data(), margins_.data());
    std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> poses(kChunk);
    std::vector<typename Arm::Solutions, Eigen::aligned_allocator<typename Arm::Solutions>> found(kChunk);
    for (std::size_t start = 0; start < block.count(); start += kChunk) {
      const std::size_t n = std::min(kChunk, block.count() - start);
      for (std::size_t i = 0; i < n; ++i) poses[i] = block.pose(start + i);
      Arm::solve_batch(poses.data(), static_cast<std::ptrdiff_t>(n), found.data());
      for (std::size_t i = 0; i < n; ++i) {
        counts_[start + i] = static_cast<std::uint8_t>(std::min(found[i].count, 255));
        for (int k = 0; k < found[i].count; ++k) best.add(found[i].q.data()[k].data(), start + i);
      }
    }
    best.finish();
  }

  // A byte a pose, then a float a pose (singular value), then a float a pose (margin); whether all could be written.
  bool write(const char* path) const noexcept {
    std::FILE* file = std::fopen(path, "wb");
    if (!file) return false;
    const std::size_t n = counts_.size();
    const bool whole = std::fwrite(counts_.data(), 1, n, file) == n &&
                       std::fwrite(singular_values_.data(), sizeof(float), n, file) == n &&
                       std::fwrite(margins_.data(), sizeof(float), n, file) == n;
    return std::fclose(file) == 0 && whole;
  }

 private:
  static constexpr std::size_t kChunk = 512;
  std::vector<std::uint8_t> counts_;
  std::vector<float> singular_values_, margins_;
};

}  // namespace ikgen_runtime
