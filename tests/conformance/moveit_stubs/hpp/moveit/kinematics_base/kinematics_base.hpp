#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <rclcpp/logging.hpp>
#include <rclcpp/node.hpp>
#include <geometry_msgs/msg/pose.hpp>
#include <moveit_msgs/msg/move_it_error_codes.hpp>
#include <stub/query.hpp>

namespace moveit::core {
class JointModelGroup;
class RobotState;
class RobotModel;
using RobotModelConstPtr = std::shared_ptr<const RobotModel>;
}  // namespace moveit::core

namespace kinematics {

class KinematicsBase {
 public:
  static constexpr double DEFAULT_SEARCH_DISCRETIZATION = 0.1;
  static constexpr double DEFAULT_TIMEOUT = 1.0;

  using IKCallbackFn = std::function<void(const geometry_msgs::msg::Pose&, const std::vector<double>&,
                                          moveit_msgs::msg::MoveItErrorCodes&)>;
  using IKCostFn = std::function<double(const geometry_msgs::msg::Pose&, const moveit::core::RobotState&,
                                        const moveit::core::JointModelGroup*, const std::vector<double>&)>;

  virtual bool getPositionIK(const geometry_msgs::msg::Pose& ik_pose, const std::vector<double>& ik_seed_state,
                             std::vector<double>& solution, moveit_msgs::msg::MoveItErrorCodes& error_code,
                             const KinematicsQueryOptions& options = KinematicsQueryOptions()) const = 0;

  virtual bool getPositionIK(const std::vector<geometry_msgs::msg::Pose>& ik_poses,
                             const std::vector<double>& ik_seed_state, std::vector<std::vector<double>>& solutions,
                             KinematicsResult& result, const KinematicsQueryOptions& options) const;

  virtual bool searchPositionIK(const geometry_msgs::msg::Pose& ik_pose, const std::vector<double>& ik_seed_state,
                                double timeout, std::vector<double>& solution,
                                moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions()) const = 0;

  virtual bool searchPositionIK(const geometry_msgs::msg::Pose& ik_pose, const std::vector<double>& ik_seed_state,
                                double timeout, const std::vector<double>& consistency_limits,
                                std::vector<double>& solution, moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions()) const = 0;

  virtual bool searchPositionIK(const geometry_msgs::msg::Pose& ik_pose, const std::vector<double>& ik_seed_state,
                                double timeout, std::vector<double>& solution, const IKCallbackFn& solution_callback,
                                moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions()) const = 0;

  virtual bool searchPositionIK(const geometry_msgs::msg::Pose& ik_pose, const std::vector<double>& ik_seed_state,
                                double timeout, const std::vector<double>& consistency_limits,
                                std::vector<double>& solution, const IKCallbackFn& solution_callback,
                                moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions()) const = 0;

  virtual bool searchPositionIK(const std::vector<geometry_msgs::msg::Pose>& ik_poses,
                                const std::vector<double>& ik_seed_state, double timeout,
                                const std::vector<double>& consistency_limits, std::vector<double>& solution,
                                const IKCallbackFn& solution_callback, moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions(),
                                const moveit::core::RobotState* context_state = nullptr) const {
    static_cast<void>(context_state);
    if (ik_poses.size() != 1) return false;
    if (solution_callback)
      return searchPositionIK(ik_poses[0], ik_seed_state, timeout, consistency_limits, solution, solution_callback,
                              error_code, options);
    return searchPositionIK(ik_poses[0], ik_seed_state, timeout, consistency_limits, solution, error_code, options);
  }

  virtual bool searchPositionIK(const std::vector<geometry_msgs::msg::Pose>& ik_poses,
                                const std::vector<double>& ik_seed_state, double timeout,
                                const std::vector<double>& consistency_limits, std::vector<double>& solution,
                                const IKCallbackFn& solution_callback, const IKCostFn& cost_function,
                                moveit_msgs::msg::MoveItErrorCodes& error_code,
                                const KinematicsQueryOptions& options = KinematicsQueryOptions(),
                                const moveit::core::RobotState* context_state = nullptr) const {
    if (cost_function) return false;
    return searchPositionIK(ik_poses, ik_seed_state, timeout, consistency_limits, solution, solution_callback,
                            error_code, options, context_state);
  }

  virtual bool getPositionFK(const std::vector<std::string>& link_names, const std::vector<double>& joint_angles,
                             std::vector<geometry_msgs::msg::Pose>& poses) const = 0;

  virtual bool initialize(const rclcpp::Node::SharedPtr& node, const moveit::core::RobotModel& robot_model,
                          const std::string& group_name, const std::string& base_frame,
                          const std::vector<std::string>& tip_frames, double search_discretization);

  virtual const std::string& getGroupName() const { return group_name_; }
  virtual const std::string& getBaseFrame() const { return base_frame_; }
  virtual const std::string& getTipFrame() const { return tip_frames_[0]; }
  virtual const std::vector<std::string>& getTipFrames() const { return tip_frames_; }

  virtual bool setRedundantJoints(const std::vector<unsigned int>& redundant_joint_indices);
  bool setRedundantJoints(const std::vector<std::string>& redundant_joint_names);
  virtual void getRedundantJoints(std::vector<unsigned int>& redundant_joint_indices) const {
    redundant_joint_indices = redundant_joint_indices_;
  }

  virtual const std::vector<std::string>& getJointNames() const = 0;
  virtual const std::vector<std::string>& getLinkNames() const = 0;

  virtual bool supportsGroup(const moveit::core::JointModelGroup* jmg, std::string* error_text_out = nullptr) const;

  void setSearchDiscretization(double sd) {
    redundant_joint_discretization_.clear();
    for (const unsigned int index : redundant_joint_indices_)
      redundant_joint_discretization_[static_cast<int>(index)] = sd;
  }
  double getSearchDiscretization(int joint_index = 0) const {
    const auto found = redundant_joint_discretization_.find(joint_index);
    return found == redundant_joint_discretization_.end() ? 0.0 : found->second;
  }

  virtual ~KinematicsBase();
  KinematicsBase();

 protected:
  rclcpp::Node::SharedPtr node_;
  moveit::core::RobotModelConstPtr robot_model_;
  std::string robot_description_;
  std::string group_name_;
  std::string base_frame_;
  std::vector<std::string> tip_frames_;

  double default_timeout_;
  std::vector<unsigned int> redundant_joint_indices_;
  std::map<int, double> redundant_joint_discretization_;
  std::vector<DiscretizationMethod> supported_methods_;

  void storeValues(const moveit::core::RobotModel& robot_model, const std::string& group_name,
                   const std::string& base_frame, const std::vector<std::string>& tip_frames,
                   double search_discretization);
};

}  // namespace kinematics
