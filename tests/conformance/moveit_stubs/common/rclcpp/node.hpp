#pragma once

#include <memory>

namespace rclcpp {

class Node {
 public:
  using SharedPtr = std::shared_ptr<Node>;
};

}  // namespace rclcpp
