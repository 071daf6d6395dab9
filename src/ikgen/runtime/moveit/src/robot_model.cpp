#include "ikgen_moveit/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

namespace ikgen_moveit {
namespace {

using moveit::core::JointModel;
using moveit::core::LinkModel;
using moveit::core::RobotModel;

constexpr double kSameGeometry = 1e-5;  // m or rad

// The values of a joint that is not fixed.
using Values = std::function<const double*(const JointModel&)>;

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out.empty() ? "none" : out;
}

// The frame of the model itself is that of the root link where a fixed joint leads there.
const LinkModel* find_link(const RobotModel& model, const std::string& frame) {
  if (model.hasLinkModel(frame)) return model.getLinkModel(frame);
  if (frame == model.getModelFrame() && model.getRootJoint()->getType() == JointModel::FIXED)
    return model.getRootLink();
  throw std::runtime_error("the robot model has no link '" + frame + "'");
}

bool is_above(const LinkModel* link, const LinkModel* other) {
  while (other != nullptr && other != link) other = other->getParentLinkModel();
  return other != nullptr;
}

// Pose of a link in one above it.
Eigen::Isometry3d climb(const LinkModel* link, const LinkModel* top, const Values& values) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (; link != top; link = link->getParentLinkModel()) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const JointModel& joint = *link->getParentJointModel();
    if (joint.getType() != JointModel::FIXED) joint.computeTransform(values(joint), motion);
    T = link->getJointOriginTransform() * motion * T;
  }
  return T;
}

// Pose of a link in another.
Eigen::Isometry3d pose_between(const LinkModel* from, const LinkModel* to, const Values& values) {
  const LinkModel* top = from;
  while (!is_above(top, to)) top = top->getParentLinkModel();
  return climb(from, top, values).inverse() * climb(to, top, values);
}

Eigen::Isometry3d fixed_pose(const RobotModel& model, const std::string& from, const std::string& to) {
  const Values none = [&](const JointModel& joint) -> const double* {
    throw std::runtime_error("the joint '" + joint.getName() + "' moves between '" + from + "' and '" + to +
                             "': they have to be rigidly connected");
  };
  return pose_between(find_link(model, from), find_link(model, to), none);
}

Eigen::Isometry3d model_forward(const RobotModel& model, const Joints& q) {
  const std::vector<double> values = group_values(q);
  const std::vector<std::string> names = group_names();
  const Values chain = [&](const JointModel& joint) {
    const auto found = std::find(names.begin(), names.end(), joint.getName());
    if (found == names.end())
      throw std::runtime_error("the joint '" + joint.getName() +
                               "' is between base and tip, but this solver does not know it");
    return &values[static_cast<std::size_t>(found - names.begin())];
  };
  return pose_between(find_link(model, ik::kBaseLink), find_link(model, ik::kTipLink), chain);
}

// Throws where the model's chain is not the one that was solved.
void check_geometry(const RobotModel& model) {
  for (const double spread : {0.0, 0.4, -0.4}) {
    Joints q;
    for (int j = 0; j < ik::kDof; ++j) {
      const auto i = static_cast<std::size_t>(j);
      q[j] = std::clamp(spread * (1.0 + 0.25 * j), ik::kLower[i], ik::kUpper[i]);
    }
    const Eigen::Isometry3d off = ik::forward(q).inverse() * model_forward(model, q);
    const double length = off.translation().norm(), angle = std::abs(Eigen::AngleAxisd(off.linear()).angle());
    if (length <= kSameGeometry && angle <= kSameGeometry) continue;
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, "%.3g mm and %.3g rad", 1e3 * length, angle);
    throw std::runtime_error("the robot model's chain is not the one that this solver was generated for: its tip is " +
                             std::string(numbers) + " away; generate the solver again");
  }
}

Limits joint_limits(const RobotModel& model) {
  Limits out = own_limits();
  for (const GroupJoint& one : kGroup) {
    const auto& bounds = model.getJointModel(one.name)->getVariableBounds().front();
    if (!bounds.position_bounded_) continue;
    const double low = (bounds.min_position_ - one.offset) / one.factor;
    const double high = (bounds.max_position_ - one.offset) / one.factor;
    double& lower = out.lower[one.joint];
    double& upper = out.upper[one.joint];
    lower = std::max(lower, std::min(low, high));
    upper = std::min(upper, std::max(low, high));
    if (!(lower <= upper))
      throw std::runtime_error("no value of the joint '" + std::string(one.name) +
                               "' is inside the limits of both the robot model and the description");
  }
  return out;
}

}  // namespace

std::string misfit(const moveit::core::JointModelGroup& group) {
  const std::vector<std::string>& names = group.getVariableNames();
  if (names == group_names()) return "";
  return "the group '" + group.getName() + "' has the joints " + listed(names) + "; this solver needs exactly " +
         listed(group_names()) + ", in this order";
}

Placement place_chain(const RobotModel& model, const std::string& group_base, const std::string& group_tip) {
  Placement out;
  out.T_base_group_base = fixed_pose(model, ik::kBaseLink, group_base);
  out.T_group_tip_tip = fixed_pose(model, group_tip, ik::kTipLink);
  if (std::string(ik::kTask) != "pose" && !out.T_group_tip_tip.isApprox(Eigen::Isometry3d::Identity(), 1e-9))
    throw std::runtime_error("the task '" + std::string(ik::kTask) +
                             "' leaves the tip's orientation open: the group's tip '" + group_tip +
                             "' has to be at '" + ik::kTipLink + "'");
  check_geometry(model);
  out.limits = joint_limits(model);
  return out;
}

}  // namespace ikgen_moveit
