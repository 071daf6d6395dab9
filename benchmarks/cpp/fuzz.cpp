// A libFuzzer target on one emitted header: whatever bytes come, no undefined behaviour, no allocation, no row wrong.
//
// Compile with clang++ -fsanitize=fuzzer,address,undefined -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik
// -DIKGEN_FREE=0 or 1 (held joints) -DFUZZ_WHOLE=0 or 1 (the task reads the whole pose). The first byte says what the
// others are: entries of a matrix, joint values as they are, or joint values inside the limits with a little noise
// on the pose's entries; then options, a seed. Aborts, so that libFuzzer keeps the bytes, where a row is not
// finite or does not give the pose, a count or a status is none, or anything was allocated.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include IKGEN_HEADER

namespace ik = IKGEN_NAMESPACE;

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

namespace {

constexpr double kRight = 1e-8;    // of rows: 1e-9 is promised of poses, of the nearest rotation of noisy ones
constexpr double kNoisy = 1e-6;    // what a pose's rotation may be off
constexpr double kLarge = 1e4;     // m; beyond, a double's own digits are coarser
bool counting = false;
int allocations = 0;

void count(const volatile void*, std::size_t) {
  if (counting) ++allocations;
}
void nothing(const volatile void*) {}

struct Bytes {
  const std::uint8_t* at;
  std::size_t left;

  std::uint8_t byte() {
    if (left == 0) return 0;
    --left;
    return *at++;
  }
  double raw() {  // any double there is
    double x = 0.0;
    const std::size_t n = left < sizeof x ? left : sizeof x;
    std::memcpy(&x, at, n);
    at += n;
    left -= n;
    return x;
  }
  double unit() { return (byte() * 256 + byte()) / 65535.0; }
};

[[noreturn]] void fail(const char* why) {
  std::fprintf(stderr, "fuzz: %s\n", why);
  std::abort();
}

double inside(double unit, int j) {
  const double low = std::fmax(ik::kLower[j], -10.0), high = std::fmin(ik::kUpper[j], 10.0);
  return low + unit * (high - low);
}

Eigen::Isometry3d pose_of(Bytes& bytes, std::uint8_t kind) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (kind % 4 == 0) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) pose.matrix()(i, j) = bytes.raw();
    return pose;
  }
  ik::Joints q;
  for (int j = 0; j < ik::kDof; ++j) q[j] = kind % 4 == 1 ? bytes.raw() : inside(bytes.unit(), j);
  pose = ik::forward(q);
  if (kind % 4 == 3) {
    const double noise = std::pow(10.0, -4.0 - bytes.byte() % 13);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) pose.matrix()(i, j) += noise * (bytes.unit() - 0.5);
  }
  return pose;
}

void check(const Eigen::Isometry3d& pose, const ik::Solutions& found, bool projected) {
  const int status = static_cast<int>(found.status);
  if (status < 0 || status > static_cast<int>(ik::Status::Invalid)) fail("no status");
  if (found.count < 0 || found.count > ik::kMaxSolutions) fail("no count");
  if ((found.status == ik::Status::Ok) != (found.count > 0) && !projected) fail("status and count differ");
  const double size = pose.translation().cwiseAbs().maxCoeff();
  for (int i = 0; i < found.count; ++i) {
    if (!found.q[static_cast<std::size_t>(i)].allFinite()) fail("a row is not finite");
    if (projected || !(size < kLarge)) continue;
#if FUZZ_WHOLE
    const Eigen::Isometry3d T = ik::forward(found.q[static_cast<std::size_t>(i)]);
    if (!((T.translation() - pose.translation()).cwiseAbs().maxCoeff() < kRight * (1.0 + size))) fail("a position is wrong");
    if (!((T.linear() - pose.linear()).cwiseAbs().maxCoeff() < 3.0 * kNoisy)) fail("a rotation is wrong");
#endif
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  __sanitizer_install_malloc_and_free_hooks(count, nothing);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes{data, size};
  const std::uint8_t kind = bytes.byte(), choices = bytes.byte();
  const Eigen::Isometry3d pose = pose_of(bytes, kind);
  ik::Options options;
  options.limits = choices & 1;
  options.project = (choices & 6) == 6;
  ik::Joints seed;
  for (int j = 0; j < ik::kDof; ++j) seed[j] = choices & 8 ? bytes.raw() : inside(bytes.unit(), j);
  if (choices & 16) options.seed = &seed;
#if IKGEN_FREE
  if (choices & 32)
    for (double& value : options.free) value = bytes.raw();
#endif
  ik::Solutions pair[2];
  const Eigen::Isometry3d poses[2] = {pose, pose};
  counting = true;
  const ik::Solutions found = ik::solve(pose, options);
  if (choices & 64) ik::solve_batch(poses, 2, pair, options);
  counting = false;
  if (allocations) fail("something was allocated");
  check(pose, found, options.project);
  if (choices & 64)
    for (const ik::Solutions& other : pair) check(pose, other, options.project);
  return 0;
}
