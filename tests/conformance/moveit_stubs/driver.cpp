// Loads the one exported plugin and serves it: a robot and calls on standard input, one a line, answers on
// standard output ("= " before the answer, "! " before what the plugin logs).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#if __has_include(<moveit/kinematics_base/kinematics_base.hpp>)
#include <moveit/kinematics_base/kinematics_base.hpp>
#include <moveit/robot_model/robot_model.hpp>
#else
#include <moveit/kinematics_base/kinematics_base.h>
#include <moveit/robot_model/robot_model.h>
#endif
#include <pluginlib/class_list_macros.hpp>
#include <stub/kinematics_base.ipp>


namespace {

using geometry_msgs::msg::Pose;
using moveit::core::JointModel;
using Codes = moveit_msgs::msg::MoveItErrorCodes;
using Values = std::vector<double>;

struct Session {
  std::unique_ptr<moveit::core::RobotModel> model;
  std::unique_ptr<kinematics::KinematicsBase> plugin;
};

template <typename T> T read(std::istream& in) {
  T out;
  if (!(in >> out)) {
    std::printf("= bad input\n");
    std::exit(1);
  }
  return out;
}

double number(std::istream& in) { return std::stod(read<std::string>(in)); }

// A count, then so many numbers or names.
Values numbers(std::istream& in) {
  Values out(read<std::size_t>(in));
  for (double& x : out) x = number(in);
  return out;
}

std::vector<std::string> names(std::istream& in) {
  std::vector<std::string> out(read<std::size_t>(in));
  for (std::string& x : out) x = read<std::string>(in);
  return out;
}

Pose pose(std::istream& in) {
  Pose out;
  for (double* x : {&out.position.x, &out.position.y, &out.position.z, &out.orientation.x, &out.orientation.y,
                    &out.orientation.z, &out.orientation.w})
    *x = number(in);
  return out;
}

void answer(const Values& values) {
  std::printf("=");
  for (const double x : values) std::printf(" %.17g", x);
  std::printf("\n");
}

// An answer that starts with a flag and a code.
void answer(bool good, int code, const Values& values) {
  Values all = {good ? 1.0 : 0.0, static_cast<double>(code)};
  all.insert(all.end(), values.begin(), values.end());
  answer(all);
}

void link(Session& session, std::istream& in) {
  static const std::map<std::string, JointModel::JointType> types = {
      {"revolute", JointModel::REVOLUTE}, {"continuous", JointModel::REVOLUTE},
      {"prismatic", JointModel::PRISMATIC}, {"fixed", JointModel::FIXED}};
  const auto link = read<std::string>(in), parent = read<std::string>(in), joint = read<std::string>(in);
  const auto type = types.at(read<std::string>(in));
  Eigen::Isometry3d origin;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) origin.matrix()(r, c) = number(in);
  Eigen::Vector3d axis;
  for (int r = 0; r < 3; ++r) axis[r] = number(in);
  moveit::core::VariableBounds bounds;
  bounds.min_position_ = number(in);
  bounds.max_position_ = number(in);
  bounds.position_bounded_ = std::isfinite(bounds.min_position_);
  session.model->add_link(link, parent, JointModel(joint, type, axis, bounds), origin);
}

void initialize(Session& session, std::istream& in) {
  const auto group = read<std::string>(in), base = read<std::string>(in);
  const auto tips = names(in);
  const double resolution = number(in);
  answer(session.plugin->initialize(nullptr, *session.model, group, base, tips, resolution), 0, {});
}

void get(Session& session, std::istream& in) {
  const Pose goal = pose(in);
  const Values seed = numbers(in);
  Values solution;
  Codes codes;
  const bool good = session.plugin->getPositionIK(goal, seed, solution, codes);
  answer(good, codes.val, solution);
}

void get_all(Session& session, std::istream& in) {
  std::vector<Pose> goals(read<std::size_t>(in));
  for (Pose& goal : goals) goal = pose(in);
  const Values seed = numbers(in);
  kinematics::KinematicsQueryOptions options;
  options.discretization_method = static_cast<kinematics::DiscretizationMethod>(read<int>(in));
  std::vector<Values> solutions;
  kinematics::KinematicsResult result = {};
  const bool good = session.plugin->getPositionIK(goals, seed, solutions, result, options);
  Values flat = {result.solution_percentage};
  for (const Values& q : solutions) flat.insert(flat.end(), q.begin(), q.end());
  answer(good, result.kinematic_error, flat);
}

// The callback: rejects so many candidates with GOAL_IN_COLLISION, each after so many seconds; keeps all of them.
struct Callback {
  int rejections;
  double wait;
  Values seen;

  void operator()(const Pose&, const Values& q, Codes& codes) {
    seen.insert(seen.end(), q.begin(), q.end());
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    codes.val = rejections-- > 0 ? Codes::GOAL_IN_COLLISION : Codes::SUCCESS;
  }
};

// Which of the overloads follows from the words: "limits" gives consistency limits, "callback" a callback,
// "poses" the overload of several tips.
void search(Session& session, std::istream& in) {
  const auto words = names(in);
  const auto has = [&](const char* word) { return std::count(words.begin(), words.end(), word) > 0; };
  const Pose goal = pose(in);
  const Values seed = numbers(in), limits = numbers(in);
  const double timeout = number(in);
  Callback callback = {read<int>(in), number(in), {}};
  kinematics::KinematicsQueryOptions options;
  options.lock_redundant_joints = has("lock");
  const kinematics::KinematicsBase& plugin = *session.plugin;
  const kinematics::KinematicsBase::IKCallbackFn call = std::ref(callback);
  Values solution;
  Codes codes;
  bool good = false;
  if (has("poses"))
    good = plugin.searchPositionIK(std::vector<Pose>{goal}, seed, timeout, limits, solution,
                                   has("callback") ? call : kinematics::KinematicsBase::IKCallbackFn(), codes, options);
  else if (has("limits") && has("callback"))
    good = plugin.searchPositionIK(goal, seed, timeout, limits, solution, call, codes, options);
  else if (has("limits"))
    good = plugin.searchPositionIK(goal, seed, timeout, limits, solution, codes, options);
  else if (has("callback"))
    good = plugin.searchPositionIK(goal, seed, timeout, solution, call, codes, options);
  else
    good = plugin.searchPositionIK(goal, seed, timeout, solution, codes, options);
  Values flat = {static_cast<double>(solution.size())};
  flat.insert(flat.end(), solution.begin(), solution.end());
  flat.insert(flat.end(), callback.seen.begin(), callback.seen.end());
  answer(good, codes.val, flat);
}

void forward(Session& session, std::istream& in) {
  const auto links = names(in);
  const Values q = numbers(in);
  std::vector<Pose> poses;
  const bool good = session.plugin->getPositionFK(links, q, poses);
  Values flat;
  for (const Pose& p : poses)
    for (const double x : {p.position.x, p.position.y, p.position.z, p.orientation.x, p.orientation.y, p.orientation.z,
                           p.orientation.w})
      flat.push_back(x);
  answer(good, 0, flat);
}

void describe(Session& session) {
  for (const std::string& name : session.plugin->getJointNames()) std::printf("! joint %s\n", name.c_str());
  for (const std::string& name : session.plugin->getLinkNames()) std::printf("! link %s\n", name.c_str());
  std::vector<unsigned int> redundant;
  session.plugin->getRedundantJoints(redundant);
  answer(Values(redundant.begin(), redundant.end()));
}

void serve(Session& session, const std::string& what, std::istream& in) {
  if (what == "model") {
    const auto frame = read<std::string>(in), type = read<std::string>(in), root = read<std::string>(in);
    session.model = std::make_unique<moveit::core::RobotModel>(
        frame, type == "fixed" ? JointModel::FIXED : JointModel::FLOATING, root);
  } else if (what == "link") {
    link(session, in);
  } else if (what == "group") {
    const auto name = read<std::string>(in);
    session.model->add_group(name, names(in));
  } else if (what == "initialize") {
    initialize(session, in);
  } else if (what == "supports") {
    std::string text;
    const bool good = session.plugin->supportsGroup(session.model->getJointModelGroup(read<std::string>(in)), &text);
    std::printf("! %s\n", text.c_str());
    answer(good, 0, {});
  } else if (what == "redundant") {
    answer(session.plugin->setRedundantJoints(names(in)), 0, {});
  } else if (what == "describe") {
    describe(session);
  } else if (what == "get") {
    get(session, in);
  } else if (what == "get_all") {
    get_all(session, in);
  } else if (what == "search") {
    search(session, in);
  } else if (what == "forward") {
    forward(session, in);
  } else {
    std::printf("= no such call\n");
  }
}

}  // namespace

int main() {
  const auto& plugins = stub::plugins<kinematics::KinematicsBase>();
  if (plugins.size() != 1) return 1;
  Session session;
  session.plugin = plugins.begin()->second();
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream in(line);
    serve(session, read<std::string>(in), in);
    std::fflush(stdout);
  }
}
