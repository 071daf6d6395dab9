#pragma once

#include <functional>

namespace boost {

template <typename Signature> class function : public std::function<Signature> {
 public:
  using std::function<Signature>::function;
  bool empty() const { return !*this; }
};

}  // namespace boost
