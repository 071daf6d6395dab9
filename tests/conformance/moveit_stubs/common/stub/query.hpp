// Options and results of kinematics queries, the same in both header styles.
#pragma once

namespace kinematics {

namespace DiscretizationMethods {
enum DiscretizationMethod {
  NO_DISCRETIZATION = 1,
  ALL_DISCRETIZED,
  SOME_DISCRETIZED,
  ALL_RANDOM_SAMPLED,
  SOME_RANDOM_SAMPLED
};
}  // namespace DiscretizationMethods
using DiscretizationMethod = DiscretizationMethods::DiscretizationMethod;

namespace KinematicErrors {
enum KinematicError {
  OK = 1,
  UNSUPORTED_DISCRETIZATION_REQUESTED,
  DISCRETIZATION_NOT_INITIALIZED,
  MULTIPLE_TIPS_NOT_SUPPORTED,
  EMPTY_TIP_POSES,
  IK_SEED_OUTSIDE_LIMITS,
  SOLVER_NOT_ACTIVE,
  NO_SOLUTION
};
}  // namespace KinematicErrors
using KinematicError = KinematicErrors::KinematicError;

struct KinematicsQueryOptions {
  bool lock_redundant_joints = false;
  bool return_approximate_solution = false;
  DiscretizationMethod discretization_method = DiscretizationMethods::NO_DISCRETIZATION;
};

struct KinematicsResult {
  KinematicError kinematic_error;
  double solution_percentage;
};

}  // namespace kinematics
