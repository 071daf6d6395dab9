// The part of MoveIt's robot model that a kinematics plugin asks about, the same in both header styles.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace moveit::core {

class LinkModel;
class RobotModel;

struct VariableBounds {
  double min_position_ = 0.0;
  double max_position_ = 0.0;
  bool position_bounded_ = false;
};

class JointModel {
 public:
  enum JointType { UNKNOWN, REVOLUTE, PRISMATIC, PLANAR, FLOATING, FIXED };
  using Bounds = std::vector<VariableBounds>;

  JointModel(const std::string& name, JointType type, const Eigen::Vector3d& axis, const VariableBounds& bounds)
      : name_(name), type_(type), axis_(axis), variable_bounds_{bounds} {}

  const std::string& getName() const { return name_; }
  JointType getType() const { return type_; }
  const Bounds& getVariableBounds() const { return variable_bounds_; }
  void computeTransform(const double* joint_values, Eigen::Isometry3d& transf) const {
    transf.setIdentity();
    if (type_ == REVOLUTE) transf.linear() = Eigen::AngleAxisd(joint_values[0], axis_).toRotationMatrix();
    if (type_ == PRISMATIC) transf.translation() = joint_values[0] * axis_;
  }

 private:
  std::string name_;
  JointType type_;
  Eigen::Vector3d axis_;
  Bounds variable_bounds_;
};

class LinkModel {
 public:
  LinkModel(const std::string& name, const LinkModel* parent, const JointModel* joint, const Eigen::Isometry3d& origin)
      : name_(name), parent_link_model_(parent), parent_joint_model_(joint), joint_origin_transform_(origin) {}

  const std::string& getName() const { return name_; }
  const JointModel* getParentJointModel() const { return parent_joint_model_; }
  const LinkModel* getParentLinkModel() const { return parent_link_model_; }
  const Eigen::Isometry3d& getJointOriginTransform() const { return joint_origin_transform_; }

 private:
  std::string name_;
  const LinkModel* parent_link_model_;
  const JointModel* parent_joint_model_;
  Eigen::Isometry3d joint_origin_transform_;
};

class JointModelGroup {
 public:
  JointModelGroup(const std::string& name, const std::vector<std::string>& variables)
      : name_(name), variable_names_(variables) {}

  const std::string& getName() const { return name_; }
  const std::vector<std::string>& getVariableNames() const { return variable_names_; }
  bool isChain() const { return true; }

 private:
  std::string name_;
  std::vector<std::string> variable_names_;
};

class RobotModel {
 public:
  RobotModel(const std::string& frame, JointModel::JointType root_type, const std::string& root_link)
      : frame_(frame), root_joint_("virtual_joint", root_type, Eigen::Vector3d::UnitZ(), {}) {
    root_link_ = &links_.emplace(root_link, LinkModel(root_link, nullptr, &root_joint_, Eigen::Isometry3d::Identity()))
                      .first->second;
  }
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;

  const std::string& getModelFrame() const { return frame_; }
  const JointModel* getRootJoint() const { return &root_joint_; }
  const LinkModel* getRootLink() const { return root_link_; }
  bool hasLinkModel(const std::string& name) const { return links_.count(name) > 0; }
  const LinkModel* getLinkModel(const std::string& link, bool* has_link = nullptr) const {
    if (has_link != nullptr) *has_link = hasLinkModel(link);
    return hasLinkModel(link) ? &links_.at(link) : nullptr;
  }
  const JointModel* getJointModel(const std::string& joint) const { return &joints_.at(joint); }
  bool hasJointModelGroup(const std::string& group) const { return groups_.count(group) > 0; }
  const JointModelGroup* getJointModelGroup(const std::string& name) const { return &groups_.at(name); }

  // How a test builds a model: parents before their children.
  void add_link(const std::string& link, const std::string& parent, const JointModel& joint,
                const Eigen::Isometry3d& origin) {
    const JointModel* added = &joints_.emplace(joint.getName(), joint).first->second;
    links_.emplace(link, LinkModel(link, getLinkModel(parent), added, origin));
  }
  void add_group(const std::string& name, const std::vector<std::string>& variables) {
    groups_.emplace(name, JointModelGroup(name, variables));
  }

 private:
  std::string frame_;
  JointModel root_joint_;
  const LinkModel* root_link_ = nullptr;
  std::map<std::string, JointModel> joints_;
  std::map<std::string, LinkModel> links_;
  std::map<std::string, JointModelGroup> groups_;
};

using RobotModelConstPtr = std::shared_ptr<const RobotModel>;

}  // namespace moveit::core
