"""The C++ program that solves a block of a map through an emitted header."""

from __future__ import annotations

__all__ = ["map_driver"]

# Request: positions, rotations (counts), 3 doubles a position, 9 a rotation (columns first).
# Answer: per pose a byte (solutions), then per pose a float (singular value), then a float (margin).
_TEXT = r"""
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>
#include <Eigen/Dense>
#include "@header@"
namespace ik = @namespace@;

constexpr int kFirst = @first@, kRows = @rows@;  // rows of the Jacobian that the task is about
constexpr int kMoving[] = {@moving@};
constexpr int kColumns = sizeof(kMoving) / sizeof(kMoving[0]);
constexpr int kSmall = kRows < kColumns ? kRows : kColumns;
constexpr double kSize = @size@;  // m: rows of lengths are taken relative to it
constexpr int kChunk = 512;

using Small = Eigen::Matrix<double, kSmall, kSmall>;

// The 256th power of the inverse is all but of rank one: its largest column is the eigenvector, to less
// than a thousandth in the value however close the next one is.
static double smallest_eigenvalue(Small A) {
  A.diagonal().array() += 1e-14 * A.trace();
  Small inverse = Small::Identity();
  Eigen::LLT<Small>(A).solveInPlace(inverse);
  Small power = inverse / inverse.trace();
  for (int doubling = 0; doubling < 8; ++doubling) {
    const Small squared = power.lazyProduct(power);
    power = squared / squared.trace();
  }
  int largest = 0;
  power.diagonal().maxCoeff(&largest);
  const Eigen::Matrix<double, kSmall, 1> x = power.col(largest).normalized();
  return 1.0 / x.dot(inverse * x);
}

static float smallest_singular_value(const ik::Joints& q) {
  const Eigen::Matrix<double, 6, ik::kDof> whole = ik::jacobian(q);
  Eigen::Matrix<double, kRows, kColumns> J;
  for (int i = 0; i < kRows; ++i) {
    const double scale = i + kFirst < 3 ? 1.0 / kSize : 1.0;
    for (int j = 0; j < kColumns; ++j) J(i, j) = scale * whole(i + kFirst, kMoving[j]);
  }
  Small A;
  if constexpr (kRows <= kColumns) A.noalias() = J * J.transpose();
  else A.noalias() = J.transpose() * J;
  return static_cast<float>(std::sqrt(smallest_eigenvalue(A)));
}

// How far from the nearest limit, as a share of half the range; 1 where no joint has limits.
static float margin(const ik::Joints& q) {
  double least = 1.0;
  for (int i = 0; i < ik::kDof; ++i) {
    const double range = ik::kUpper[i] - ik::kLower[i];
    if (!std::isfinite(range) || range <= 0.0) continue;
    least = std::min(least, 2.0 * std::min(q[i] - ik::kLower[i], ik::kUpper[i] - q[i]) / range);
  }
  return static_cast<float>(std::max(least, 0.0));
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::FILE* file = std::fopen(argv[1], "rb");
  double head[2];
  if (!file || std::fread(head, sizeof(double), 2, file) != 2) return 2;
  const std::size_t positions = head[0], rotations = head[1], poses = positions * rotations;
  std::vector<double> numbers(3 * positions + 9 * rotations);
  if (std::fread(numbers.data(), sizeof(double), numbers.size(), file) != numbers.size()) return 2;
  std::fclose(file);
  const double *at = numbers.data(), *turned = at + 3 * positions;
  std::vector<std::uint8_t> count(poses);
  std::vector<float> sigma(poses), spare(poses);
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> batch(kChunk);
  std::vector<ik::Solutions, Eigen::aligned_allocator<ik::Solutions>> found(kChunk);
  for (std::size_t start = 0; start < poses; start += kChunk) {
    const std::size_t n = std::min<std::size_t>(kChunk, poses - start);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t p = (start + i) / rotations, r = (start + i) % rotations;
      batch[i].setIdentity();
      batch[i].linear() = Eigen::Map<const Eigen::Matrix3d>(turned + 9 * r);
      batch[i].translation() = Eigen::Map<const Eigen::Vector3d>(at + 3 * p);
    }
    ik::solve_batch(batch.data(), n, found.data());
    for (std::size_t i = 0; i < n; ++i) {
      count[start + i] = static_cast<std::uint8_t>(std::min(found[i].count, 255));
      for (const ik::Joints& q : found[i]) {
        sigma[start + i] = std::max(sigma[start + i], smallest_singular_value(q));
        spare[start + i] = std::max(spare[start + i], margin(q));
      }
    }
  }
  file = std::fopen(argv[2], "wb");
  const bool written = file && std::fwrite(count.data(), 1, poses, file) == poses &&
                       std::fwrite(sigma.data(), sizeof(float), poses, file) == poses &&
                       std::fwrite(spare.data(), sizeof(float), poses, file) == poses;
  return written && std::fclose(file) == 0 ? 0 : 2;
}
"""


def map_driver(
    header: str, namespace: str, *, rows: tuple[int, int], moving: tuple[int, ...], size: float
) -> str:
    """Text of the program for a header (file name): `rows` are the first row of the Jacobian and how many,
    `moving` its columns, `size` (m) what lengths are relative to."""
    values = {
        "header": header,
        "namespace": namespace,
        "first": str(rows[0]),
        "rows": str(rows[1]),
        "moving": ", ".join(map(str, moving)),
        "size": repr(float(size)),
    }
    text = _TEXT
    for name, value in values.items():
        text = text.replace(f"@{name}@", value)
    return text.lstrip()
