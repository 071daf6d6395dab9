#pragma once

#include <cstdio>
#include <string>

namespace rclcpp {

class Logger {
 public:
  explicit Logger(std::string name) : name_(std::move(name)) {}
  const char* get_name() const { return name_.c_str(); }

 private:
  std::string name_;
};

inline Logger get_logger(const std::string& name) { return Logger(name); }

}  // namespace rclcpp

// The driver's answers start with "= ", what is logged with "! ".
#define RCLCPP_ERROR(logger, ...)                    \
  do {                                               \
    std::printf("! [%s] ", (logger).get_name());     \
    std::printf(__VA_ARGS__);                        \
    std::printf("\n");                               \
  } while (false)
