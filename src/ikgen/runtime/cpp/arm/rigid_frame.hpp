// Rigid transforms, of numbers or of packs.
#pragma once

namespace ikgen_runtime {

template <class X> struct FrameOf {
  X R[3][3], p[3];
};
using Frame = FrameOf<double>;
inline constexpr Frame kIdentity = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {0.0, 0.0, 0.0}};

template <class X, class Y> inline FrameOf<X> compose(const FrameOf<X>& a, const FrameOf<Y>& b) noexcept {
  FrameOf<X> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.R[i][j] = a.R[i][0] * b.R[0][j] + a.R[i][1] * b.R[1][j] + a.R[i][2] * b.R[2][j];
    out.p[i] = a.R[i][0] * b.p[0] + a.R[i][1] * b.p[1] + a.R[i][2] * b.p[2] + a.p[i];
  }
  return out;
}

template <class X> inline FrameOf<X> inverse(const FrameOf<X>& a) noexcept {
  FrameOf<X> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.R[i][j] = a.R[j][i];
    out.p[i] = -(a.R[0][i] * a.p[0] + a.R[1][i] * a.p[1] + a.R[2][i] * a.p[2]);
  }
  return out;
}

// To a * Rz with the angle's cosine c and sine s.
template <class X> inline void rotate(FrameOf<X>& a, const X& c, const X& s) noexcept {
  for (auto& row : a.R) {
    const X x = row[0], y = row[1];
    row[0] = c * x + s * y;
    row[1] = c * y - s * x;
  }
}
template <class X> inline FrameOf<X> rotated(FrameOf<X> a, const X& c, const X& s) noexcept {
  rotate(a, c, s);
  return a;
}

// a * Tz
inline Frame slid(Frame a, double d) noexcept {
  for (int i = 0; i < 3; ++i) a.p[i] += d * a.R[i][2];
  return a;
}

}  // namespace ikgen_runtime
