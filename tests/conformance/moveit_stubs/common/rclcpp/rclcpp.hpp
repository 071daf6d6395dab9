#pragma once

#include <rclcpp/logging.hpp>
#include <rclcpp/node.hpp>
