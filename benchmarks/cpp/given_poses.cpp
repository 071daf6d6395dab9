// Times solve of one emitted header on given poses.
//
// Compile as bench.cpp; the argument is a file of poses, 16 doubles each, row by row. Prints: ns per solve of the
// processor's time, best of the rounds.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <vector>

#include IKGEN_HEADER

namespace ik = IKGEN_NAMESPACE;

int main(int, char** arguments) {
  std::ifstream file(arguments[1], std::ios::binary);
  std::vector<Eigen::Isometry3d> poses;
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> T;
  while (file.read(reinterpret_cast<char*>(T.data()), sizeof(double) * 16)) {
    poses.emplace_back();
    poses.back().matrix() = T;
  }
  double best = 1e300;
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    for (const Eigen::Isometry3d& pose : poses) {
      const ik::Solutions found = ik::solve(pose);
      asm volatile("" : : "g"(&found) : "memory");  // all of it is wanted
    }
    best = std::min(best, 1e9 / CLOCKS_PER_SEC * static_cast<double>(std::clock() - start));
  }
  std::printf("%.1f\n", best / static_cast<double>(poses.size()));
  return 0;
}
