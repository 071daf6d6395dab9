"""The program that runs an emitted header: it reads poses or joint values, and writes answers."""

from __future__ import annotations

__all__ = ["driver"]

# Requests and answers are those of `ikgen.verify.runners.program_runner`.
_DRIVER = r"""
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>
#include "@header@"
namespace ik = @namespace@;
using Numbers = std::vector<double>;

static void put(Numbers& out, const double* values, int n) {
  out.insert(out.end(), values, values + n);
}

static Eigen::Isometry3d take_pose(const double*& in) {
  Eigen::Isometry3d pose;
  std::copy(in, in + 16, pose.matrix().data());
  in += 16;
  return pose;
}

static ik::Joints take_joints(const double*& in) {
  const ik::Joints q = Eigen::Map<const ik::Joints>(in);
  in += ik::kDof;
  return q;
}

static double number(ik::Status status) {
  switch (status) {
    case ik::Status::Ok: return 0;
    case ik::Status::Unreachable: return 1;
    case ik::Status::Limits: return 2;
    case ik::Status::Invalid: return 3;
    case ik::Status::Singular: return 4;
  }
  return -1;
}

static void put(Numbers& out, const ik::Solutions& found) {
  out.push_back(number(found.status));
  out.push_back(found.count);
  for (int k = 0; k < ik::kMaxSolutions; ++k) {
    const bool row = k < found.count;
    for (int i = 0; i < ik::kDof; ++i) out.push_back(row ? found.q[k][i] : 0.0);
    out.push_back(row && found.singular[k] ? 1.0 : 0.0);
  }
}

template <class O> static auto hold(O& options, bool seed, int) -> decltype((void)options.hold_seed) {
  options.hold_seed = seed;
}
template <class O> static void hold(O&, bool, long) {}

static void solve(const double*& in, bool has_free, bool has_seed, bool limits, Numbers& out) {
  const Eigen::Isometry3d pose = take_pose(in);
  ik::Options options;
  options.limits = limits;
  if (has_free) for (int i = 0; i < ik::kFree; ++i) options.free[i] = *in++;
  hold(options, !has_free, 0);
  ik::Joints seed;
  if (has_seed) {
    seed = take_joints(in);
    options.seed = &seed;
  }
  put(out, ik::solve(pose, options));
}

@batch@
@motions@
@intervals@
@constants@
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Numbers input, out;
  std::FILE* file = std::fopen(argv[1], "rb");
  if (!file) return 2;
  std::fseek(file, 0, SEEK_END);
  input.resize(std::ftell(file) / sizeof(double));
  std::rewind(file);
  if (std::fread(input.data(), sizeof(double), input.size(), file) != input.size()) return 2;
  std::fclose(file);
  const int mode = input[0], n = input[1];
  const double* in = input.data() + 5;
  if (mode == 0) {
    out = {double(ik::kDof), double(ik::kFree), double(ik::kMaxSolutions)};
    put(out, ik::Options().free.data(), ik::kFree);
    put_constants(out);
  }
  if (mode == 4) solve_batch(in, n, input[4] != 0, out);
  if (mode == 5) follow(in, n, out);
  for (int i = 0; mode == 6 && i < n; ++i) search(in, out);
  for (int i = 0; mode == 7 && i < n; ++i) self_motion(in, out);
  for (int i = 0; mode > 0 && mode < 4 && i < n; ++i) {
    if (mode == 1) {
      solve(in, input[2] != 0, input[3] != 0, input[4] != 0, out);
      continue;
    }
    const ik::Joints q = take_joints(in);
    if (mode == 2) {
      const Eigen::Matrix4d T = ik::forward(q).matrix();
      put(out, T.data(), 16);
    } else {
      const Eigen::Matrix<double, 6, ik::kDof> J = ik::jacobian(q);
      put(out, J.data(), 6 * ik::kDof);
    }
  }
  file = std::fopen(argv[2], "wb");
  if (!file || std::fwrite(out.data(), sizeof(double), out.size(), file) != out.size()) return 2;
  return std::fclose(file) == 0 ? 0 : 2;
}
"""

_BATCH = r"""
static void solve_batch(const double* in, int n, bool limits, Numbers& out) {
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> poses;
  for (int i = 0; i < n; ++i) poses.push_back(take_pose(in));
  std::vector<ik::Solutions, Eigen::aligned_allocator<ik::Solutions>> found(poses.size());
  ik::Options options;
  options.limits = limits;
  ik::solve_batch(poses.data(), n, found.data(), options);
  for (const ik::Solutions& one : found) put(out, one);
}
"""
_NO_BATCH = "static void solve_batch(const double*, int, bool, Numbers&) {}"

_MOTIONS = r"""
static void follow(const double* in, int n, Numbers& out) {
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> poses;
  ik::Joints start;
  for (int i = 0; i < n; ++i) {
    poses.push_back(take_pose(in));
    start = take_joints(in);
  }
  std::vector<ik::Joints, Eigen::aligned_allocator<ik::Joints>> q(poses.size());
  const auto singular = std::make_unique<bool[]>(poses.size());
  const ik::Path path = ik::follow(poses.data(), n, start, q.data(), true, singular.get());
  out.push_back(number(path.status));
  out.push_back(static_cast<double>(path.reached));
  for (int i = 0; i < n; ++i) {
    const bool row = i < path.reached;
    for (int j = 0; j < ik::kDof; ++j) out.push_back(row ? q[i][j] : 0.0);
    out.push_back(row && singular[i] ? 1.0 : 0.0);
  }
}

static void search(const double*& in, Numbers& out) {
  const Eigen::Isometry3d pose = take_pose(in);
  const ik::Joints seed = take_joints(in);
  ik::SearchOptions options;
  options.seed = &seed;
  put(out, ik::search(pose, options));
}
"""
_NO_MOTIONS = """
static void follow(const double*, int, Numbers&) {}
static void search(const double*&, Numbers&) {}
"""

_INTERVALS = r"""
static void self_motion(const double*& in, Numbers& out) {
  const ik::SelfMotion found = ik::self_motion(take_pose(in));
  out.push_back(found.count);
  for (const ik::Interval& one : found) {
    out.push_back(one.low);
    out.push_back(one.high);
  }
}
"""
_NO_INTERVALS = "static void self_motion(const double*&, Numbers&) {}"

_CONSTANTS = r"""
static void put(Numbers& out, const std::string& text) {
  out.push_back(double(text.size()));
  for (const char c : text) out.push_back(static_cast<unsigned char>(c));
}

static void put_constants(Numbers& out) {
  put(out, ik::kLower.data(), ik::kDof);
  put(out, ik::kUpper.data(), ik::kDof);
  for (const char* link : {ik::kBaseLink, ik::kTipLink}) put(out, std::string(link));
  for (const char* name : ik::kJointNames) put(out, std::string(name));
}
"""
_NO_CONSTANTS = "static void put_constants(Numbers&) {}"


def driver(
    header: str, namespace: str, *, batch: bool, constants: bool, motions: bool, intervals: bool
) -> str:
    """Text of the program for a header (file name), with or without its `solve_batch`, its constants, its
    `follow` and `search`, and its `self_motion`."""
    parts = {
        "header": header,
        "namespace": namespace,
        "batch": _BATCH if batch else _NO_BATCH,
        "motions": _MOTIONS if motions else _NO_MOTIONS,
        "intervals": _INTERVALS if intervals else _NO_INTERVALS,
        "constants": _CONSTANTS if constants else _NO_CONSTANTS,
    }
    program = _DRIVER
    for name, part in parts.items():
        program = program.replace(f"@{name}@", part.strip())
    return program
