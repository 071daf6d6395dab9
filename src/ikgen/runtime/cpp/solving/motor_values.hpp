// Values of motors in place of joints', where a matrix is between the two.
#pragma once

namespace ikgen_runtime {

// `joints = kTransmission * motors + kTransmissionOffset`. Arm: kDof, Joints, Solutions; these two, and
// kTransmissionInverse.
template <class Arm> struct MotorValues {
  using Joints = typename Arm::Joints;

  static Joints to_joints(const Joints& motors) noexcept {
    Joints out;
    for (int i = 0; i < Arm::kDof; ++i) {
      double sum = Arm::kTransmissionOffset[i];
      for (int j = 0; j < Arm::kDof; ++j) sum += Arm::kTransmission[i][j] * motors.data()[j];
      out.data()[i] = sum;
    }
    return out;
  }

  static Joints to_motors(const Joints& values) noexcept {
    Joints out;
    for (int i = 0; i < Arm::kDof; ++i) {
      double sum = 0.0;
      for (int j = 0; j < Arm::kDof; ++j)
        sum += Arm::kTransmissionInverse[i][j] * (values.data()[j] - Arm::kTransmissionOffset[j]);
      out.data()[i] = sum;
    }
    return out;
  }

  static void rows_to_motors(typename Arm::Solutions& out) noexcept {
    for (int k = 0; k < out.count; ++k) out.q.data()[k] = to_motors(out.q.data()[k]);
  }

  // The Jacobian by the motors; J: a matrix of six rows, columns first.
  template <class J> static J by_motors(const J& by_joints) noexcept {
    J out;
    for (int j = 0; j < Arm::kDof; ++j)
      for (int r = 0; r < 6; ++r) {
        double sum = 0.0;
        for (int i = 0; i < Arm::kDof; ++i) sum += by_joints.data()[6 * i + r] * Arm::kTransmission[i][j];
        out.data()[6 * j + r] = sum;
      }
    return out;
  }

  // Options whose seed is of joints; they point into it.
  template <class O> struct OfJoints {
    O options;
    Joints seed = Joints::Zero();

    explicit OfJoints(const O& given) noexcept : options(given) {
      if (!given.seed) return;
      seed = to_joints(*given.seed);
      options.seed = &seed;
    }
    OfJoints(const OfJoints&) = delete;
    OfJoints& operator=(const OfJoints&) = delete;
  };
};

}  // namespace ikgen_runtime
