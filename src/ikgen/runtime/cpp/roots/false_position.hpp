#pragma once

namespace ikgen_runtime {

// Where a value changes its sign between two places, `first` and `last` its values there: by false position, halving what an
// end keeps (Dowell & Jarratt 1971).
struct FalsePosition {
  double first, last;
  int kept = 0;

  // Of the way from one to the other, where to look next.
  double share() const noexcept { return first / (first - last); }

  // The value there takes the place of one of them.
  void take(double value, bool of_first) noexcept {
    const int end = of_first ? 1 : -1;
    (of_first ? first : last) = value;
    if (kept == end) (of_first ? last : first) *= 0.5;
    kept = end;
  }
};

}  // namespace ikgen_runtime
