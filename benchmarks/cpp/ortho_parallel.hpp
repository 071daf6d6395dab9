// What a careful programmer writes by hand for one arm of one class: ortho-parallel base and spherical wrist, from the
// formulas of Brandstötter, Angerer and Hofbaur, "An analytical solution of the inverse kinematics problem of
// industrial serial manipulators with an ortho-parallel basis and a spherical wrist" (2014), with the functions of the
// standard library. All eight solutions; those that are not real hold NaN.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace ortho_parallel {

// Lengths of an arm with 10 kg payload, in m.
inline constexpr double a1 = 0.1, a2 = -0.135, b = 0.0, c1 = 0.615, c2 = 0.705, c3 = 0.755, c4 = 0.085;
inline constexpr double kPi = 3.14159265358979323846;
using Row = std::array<double, 6>;

inline Eigen::Isometry3d forward(const Row& q) {
  const double k = std::hypot(a2, c3), arm = q[1] + q[2] + std::atan2(a2, c3);
  const double x = c2 * std::sin(q[1]) + k * std::sin(arm) + a1, z = c2 * std::cos(q[1]) + k * std::cos(arm) + c1;
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const AngleAxisd base(q[0], Vector3d::UnitZ());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (base * AngleAxisd(q[1] + q[2], Vector3d::UnitY()) * AngleAxisd(q[3], Vector3d::UnitZ()) *
                   AngleAxisd(q[4], Vector3d::UnitY()) * AngleAxisd(q[5], Vector3d::UnitZ()))
                      .toRotationMatrix();
  pose.translation() = base * Vector3d(x, b, z) + c4 * pose.linear().col(2);
  return pose;
}

inline std::array<Row, 8> inverse(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d& e = pose.matrix().topLeftCorner<3, 3>();
  const Eigen::Vector3d c = pose.translation() - c4 * e.col(2);
  const double n = std::sqrt(c[0] * c[0] + c[1] * c[1] - b * b) - a1, h = c[2] - c1, far = n + 2.0 * a1;
  const double s1 = n * n + h * h, s2 = far * far + h * h, k = a2 * a2 + c3 * c3;
  const double turn = std::atan2(c[1], c[0]), side = std::atan2(b, n + a1), bend = std::atan2(a2, c3);
  const double first[2] = {turn - side, turn + side - kPi};
  const double reach[2] = {s1, s2}, tilt[2] = {std::atan2(n, h), -std::atan2(far, h)};
  std::array<Row, 8> rows;
  for (int shoulder = 0; shoulder < 2; ++shoulder) {
    const double s = std::sqrt(reach[shoulder]);
    const double lift = std::acos((reach[shoulder] + c2 * c2 - k) / (2.0 * s * c2));
    const double elbow = std::acos((reach[shoulder] - c2 * c2 - k) / (2.0 * c2 * std::sqrt(k)));
    const double sin1 = std::sin(first[shoulder]), cos1 = std::cos(first[shoulder]);
    for (int up = 0; up < 2; ++up) {
      const double sign = up ? 1.0 : -1.0;
      const double q2 = sign * lift + tilt[shoulder], q3 = -sign * elbow - bend;
      const double sin23 = std::sin(q2 + q3), cos23 = std::cos(q2 + q3);
      const Eigen::RowVector3d z = sin23 * (cos1 * e.row(0) + sin1 * e.row(1)) + cos23 * e.row(2);
      const double q4 = std::atan2(e(1, 2) * cos1 - e(0, 2) * sin1,
                                   cos23 * (e(0, 2) * cos1 + e(1, 2) * sin1) - e(2, 2) * sin23);
      const double q5 = std::atan2(std::sqrt(1.0 - z[2] * z[2]), z[2]), q6 = std::atan2(z[1], -z[0]);
      rows[4 * shoulder + 2 * up] = {first[shoulder], q2, q3, q4, q5, q6};
      rows[4 * shoulder + 2 * up + 1] = {first[shoulder], q2, q3, q4 + kPi, -q5, q6 - kPi};
    }
  }
  return rows;
}

}  // namespace ortho_parallel
