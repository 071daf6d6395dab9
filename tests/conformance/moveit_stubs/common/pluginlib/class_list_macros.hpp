#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace stub {

// Makers of the exported classes of a base class, by their names.
template <typename Base> std::map<std::string, std::function<std::unique_ptr<Base>()>>& plugins() {
  static std::map<std::string, std::function<std::unique_ptr<Base>()>> all;
  return all;
}

template <typename Derived, typename Base> struct Registration {
  explicit Registration(const std::string& name) {
    plugins<Base>()[name] = [] { return std::make_unique<Derived>(); };
  }
};

}  // namespace stub

#define PLUGINLIB_EXPORT_CLASS(class_type, base_class_type)                            \
  namespace {                                                                          \
  const stub::Registration<class_type, base_class_type> exported_plugin(#class_type);  \
  }
