#include "ikgen_moveit/kinematics_plugin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <pluginlib/class_list_macros.hpp>
#include <rclcpp/logging.hpp>

#include "ikgen_moveit/messages.hpp"

namespace ikgen_moveit {
namespace {

namespace errors = kinematics::KinematicErrors;
namespace methods = kinematics::DiscretizationMethods;
using Errors = KinematicsPlugin::ErrorCodes;

rclcpp::Logger logger() { return rclcpp::get_logger("ikgen_moveit"); }

int error_of(Outcome outcome, int callback_error) {
  switch (outcome) {
    case Outcome::Found:
      return Errors::SUCCESS;
    case Outcome::Rejected:
      return callback_error;
    case Outcome::TimedOut:
      return Errors::TIMED_OUT;
    default:
      return Errors::NO_IK_SOLUTION;
  }
}

bool fails(kinematics::KinematicsResult& result, kinematics::KinematicError error) {
  result.kinematic_error = error;
  return false;
}

}  // namespace

KinematicsPlugin::KinematicsPlugin() {
  joint_names_ = group_names();
  if (ik::kFree > 0) supported_methods_.push_back(methods::ALL_DISCRETIZED);
}

bool KinematicsPlugin::initialize(const rclcpp::Node::SharedPtr& node, const moveit::core::RobotModel& robot_model,
                                  const std::string& group_name, const std::string& base_frame,
                                  const std::vector<std::string>& tip_frames, double search_discretization) {
  initialized_ = false;
  node_ = node;
  redundant_joint_indices_.clear();
  for (const unsigned int place : kHeldPlaces) redundant_joint_indices_.push_back(place);
  storeValues(robot_model, group_name, base_frame, tip_frames, search_discretization);
  try {
    if (tip_frames_.size() != 1) throw std::runtime_error("this solver has one tip");
    if (!robot_model.hasJointModelGroup(group_name)) throw std::runtime_error("the robot model has no such group");
    const std::string reason = misfit(*robot_model.getJointModelGroup(group_name));
    if (!reason.empty()) throw std::runtime_error(reason);
    placement_ = place_chain(robot_model, base_frame_, tip_frames_.front());
    initialized_ = true;
  } catch (const std::runtime_error& error) {
    RCLCPP_ERROR(logger(), "group '%s': %s", group_name.c_str(), error.what());
  }
  return initialized_;
}

std::optional<Query> KinematicsPlugin::query(const Pose& pose, const Values& seed,
                                             const Values& consistency_limits) const {
  const auto finite = [](double x) { return std::isfinite(x); };
  const auto refuse = [](const char* reason) {
    RCLCPP_ERROR(logger(), "%s", reason);
    return std::nullopt;
  };
  if (!initialized_) return refuse("the solver is not initialized");
  if (seed.size() != joint_names_.size()) return refuse("the seed needs one value a joint");
  if (!std::all_of(seed.begin(), seed.end(), finite)) return refuse("the seed has values that are no numbers");
  if (!consistency_limits.empty() && consistency_limits.size() != joint_names_.size())
    return refuse("the consistency limits need one value a joint, or none");
  const auto target = from_message(pose);
  if (!target) return refuse("the pose is none: its position is not finite or its quaternion not of unit length");

  Query out;
  out.pose = placement_.T_base_group_base * *target * placement_.T_group_tip_tip;
  out.seed = joint_values(seed);
  out.reach.setConstant(std::numeric_limits<double>::infinity());
  if (!consistency_limits.empty()) out.reach = joint_reach(consistency_limits);
  out.limits = placement_.limits;
  return out;
}

double KinematicsPlugin::resolution() const {
  for (const unsigned int place : kHeldPlaces)
    if (const double given = getSearchDiscretization(static_cast<int>(place)); given > 0.0) return given;
  return DEFAULT_SEARCH_DISCRETIZATION;
}

bool KinematicsPlugin::getPositionIK(const Pose& ik_pose, const Values& ik_seed_state, Values& solution,
                                     ErrorCodes& error_code, const Options& options) const {
  Options locked = options;
  locked.lock_redundant_joints = true;
  return searchPositionIK(ik_pose, ik_seed_state, 0.0, Values(), solution, IKCallbackFn(), error_code, locked);
}

bool KinematicsPlugin::getPositionIK(const std::vector<Pose>& ik_poses, const Values& ik_seed_state,
                                     std::vector<Values>& solutions, kinematics::KinematicsResult& result,
                                     const Options& options) const {
  solutions.clear();
  result.solution_percentage = 0.0;
  if (!initialized_) return fails(result, errors::SOLVER_NOT_ACTIVE);
  if (ik_poses.empty()) return fails(result, errors::EMPTY_TIP_POSES);
  if (ik_poses.size() > 1) return fails(result, errors::MULTIPLE_TIPS_NOT_SUPPORTED);
  const auto method = options.discretization_method;
  if (std::find(supported_methods_.begin(), supported_methods_.end(), method) == supported_methods_.end())
    return fails(result, errors::UNSUPORTED_DISCRETIZATION_REQUESTED);
  const auto asked = query(ik_poses.front(), ik_seed_state, Values());
  if (!asked) return fails(result, errors::NO_SOLUTION);

  const bool sample = method != methods::NO_DISCRETIZATION && !options.lock_redundant_joints;
  const Effort effort = {Clock::now(), resolution(), sample};
  for (const Joints& q : all_candidates(*asked, effort, result.solution_percentage))
    solutions.push_back(group_values(q));
  if (solutions.empty()) return fails(result, errors::NO_SOLUTION);
  result.kinematic_error = errors::OK;
  return true;
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                                        Values& solution, ErrorCodes& error_code, const Options& options) const {
  return searchPositionIK(ik_pose, ik_seed_state, timeout, Values(), solution, IKCallbackFn(), error_code, options);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                                        const Values& consistency_limits, Values& solution, ErrorCodes& error_code,
                                        const Options& options) const {
  return searchPositionIK(ik_pose, ik_seed_state, timeout, consistency_limits, solution, IKCallbackFn(), error_code,
                          options);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                                        Values& solution, const IKCallbackFn& solution_callback,
                                        ErrorCodes& error_code, const Options& options) const {
  return searchPositionIK(ik_pose, ik_seed_state, timeout, Values(), solution, solution_callback, error_code, options);
}

bool KinematicsPlugin::searchPositionIK(const Pose& ik_pose, const Values& ik_seed_state, double timeout,
                                        const Values& consistency_limits, Values& solution,
                                        const IKCallbackFn& solution_callback, ErrorCodes& error_code,
                                        const Options& options) const {
  const Effort effort = {after(timeout), resolution(), !options.lock_redundant_joints};
  error_code.val = Errors::NO_IK_SOLUTION;
  const auto asked = query(ik_pose, ik_seed_state, consistency_limits);
  if (!asked) return false;

  const auto accept = [&](const Joints& q) {
    if (!solution_callback) return true;
    error_code.val = Errors::NO_IK_SOLUTION;  // until the callback says otherwise
    solution_callback(ik_pose, group_values(q), error_code);
    return error_code.val == Errors::SUCCESS;
  };
  Joints found;
  const Outcome outcome = search(*asked, effort, accept, found);
  error_code.val = error_of(outcome, error_code.val);
  if (outcome == Outcome::Found) solution = group_values(found);
  return outcome == Outcome::Found;
}

bool KinematicsPlugin::getPositionFK(const std::vector<std::string>& link_names, const Values& joint_angles,
                                     std::vector<Pose>& poses) const {
  if (!initialized_ || joint_angles.size() != joint_names_.size()) {
    RCLCPP_ERROR(logger(), "forward kinematics needs an initialized solver and one value a joint");
    return false;
  }
  const Eigen::Isometry3d T_base_tip = ik::forward(joint_values(joint_angles));
  const Pose tip =
      to_message(placement_.T_base_group_base.inverse() * T_base_tip * placement_.T_group_tip_tip.inverse());
  for (const std::string& name : link_names) {
    if (name == tip_frames_.front()) continue;
    RCLCPP_ERROR(logger(), "no forward kinematics of the link '%s', only of '%s'", name.c_str(),
                 tip_frames_.front().c_str());
    return false;
  }
  poses.assign(link_names.size(), tip);
  return true;
}

bool KinematicsPlugin::supportsGroup(const moveit::core::JointModelGroup* jmg, std::string* error_text_out) const {
  const std::string reason = jmg == nullptr ? "there is no group" : misfit(*jmg);
  if (error_text_out != nullptr && !reason.empty()) *error_text_out = reason;
  return reason.empty();
}

bool KinematicsPlugin::setRedundantJoints(const std::vector<unsigned int>& redundant_joint_indices) {
  return redundant_joint_indices == redundant_joint_indices_;
}

}  // namespace ikgen_moveit

PLUGINLIB_EXPORT_CLASS(ikgen_moveit::KinematicsPlugin, kinematics::KinematicsBase)
