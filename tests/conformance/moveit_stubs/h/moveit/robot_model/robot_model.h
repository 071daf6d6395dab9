#pragma once

#include <stub/robot_model.hpp>
