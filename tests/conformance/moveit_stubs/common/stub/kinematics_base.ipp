// Definitions of the interface's own members, compiled once, with the driver.
#include <algorithm>

namespace kinematics {

KinematicsBase::KinematicsBase() : default_timeout_(DEFAULT_TIMEOUT) {
  supported_methods_.push_back(DiscretizationMethods::NO_DISCRETIZATION);
}

KinematicsBase::~KinematicsBase() = default;

bool KinematicsBase::getPositionIK(const std::vector<geometry_msgs::msg::Pose>&, const std::vector<double>&,
                                   std::vector<std::vector<double>>&, KinematicsResult&,
                                   const KinematicsQueryOptions&) const {
  return false;
}

bool KinematicsBase::initialize(const rclcpp::Node::SharedPtr&, const moveit::core::RobotModel&, const std::string&,
                                const std::string&, const std::vector<std::string>&, double) {
  return false;
}

bool KinematicsBase::setRedundantJoints(const std::vector<unsigned int>& redundant_joint_indices) {
  redundant_joint_indices_ = redundant_joint_indices;
  return true;
}

bool KinematicsBase::setRedundantJoints(const std::vector<std::string>& redundant_joint_names) {
  const std::vector<std::string>& names = getJointNames();
  std::vector<unsigned int> indices;
  for (const std::string& name : redundant_joint_names)
    indices.push_back(static_cast<unsigned int>(std::find(names.begin(), names.end(), name) - names.begin()));
  return setRedundantJoints(indices);
}

bool KinematicsBase::supportsGroup(const moveit::core::JointModelGroup* jmg, std::string*) const {
  return jmg->isChain();
}

void KinematicsBase::storeValues(const moveit::core::RobotModel& robot_model, const std::string& group_name,
                                 const std::string& base_frame, const std::vector<std::string>& tip_frames,
                                 double search_discretization) {
  robot_model_ = moveit::core::RobotModelConstPtr(&robot_model, [](const moveit::core::RobotModel*) {});
  const auto no_slash = [](const std::string& name) {
    return name.substr(std::min(name.find_first_not_of('/'), name.size()));
  };
  group_name_ = group_name;
  base_frame_ = no_slash(base_frame);
  tip_frames_.clear();
  for (const std::string& name : tip_frames) tip_frames_.push_back(no_slash(name));
  setSearchDiscretization(search_discretization);
}

}  // namespace kinematics
