// Positions, each with all rotations, as a file.
#pragma once

#include <cstddef>
#include <cstdio>
#include <vector>

#include <Eigen/Geometry>

namespace ikgen_runtime {

// The file holds doubles: how many positions and rotations, then 3 a position, 9 a rotation (columns first).
struct PoseBlock {
  std::size_t positions = 0, rotations = 0;
  std::vector<double> numbers;

  // Whether the file could be read.
  bool read(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    if (!file) return false;
    double head[2];
    bool whole = std::fread(head, sizeof(double), 2, file) == 2;
    if (whole) {
      positions = static_cast<std::size_t>(head[0]);
      rotations = static_cast<std::size_t>(head[1]);
      numbers.resize(3 * positions + 9 * rotations);
      whole = std::fread(numbers.data(), sizeof(double), numbers.size(), file) == numbers.size();
    }
    std::fclose(file);
    return whole;
  }

  std::size_t count() const noexcept { return positions * rotations; }

  // Rotations fastest.
  Eigen::Isometry3d pose(std::size_t i) const noexcept {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Map<const Eigen::Matrix3d>(numbers.data() + 3 * positions + 9 * (i % rotations));
    out.translation() = Eigen::Map<const Eigen::Vector3d>(numbers.data() + 3 * (i / rotations));
    return out;
  }
};

}  // namespace ikgen_runtime
