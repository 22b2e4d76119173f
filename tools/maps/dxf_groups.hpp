#pragma once

#include <string>

#include <Eigen/Core>

namespace planum::dxf {

/// Appends a group: its code, then its value, a line each.
void append(std::string& text, int code, const std::string& value);
void append(std::string& text, int code, const char* value);
void append(std::string& text, int code, int value);
void append(std::string& text, int code, double value);

/// Handles are hexadecimal.
void append_handle(std::string& text, int code, unsigned handle);

/// x with the code given, y with ten more; in space, a z of 0 with twenty more.
void append_point(std::string& text, const Eigen::Vector2d& p, int first_code = 10);
void append_point_in_space(std::string& text, const Eigen::Vector2d& p, int first_code = 10);

/// UTF-8 as one line of ASCII: `\U+XXXX` for what is not, `?` for what is no character.
std::string in_ascii(const std::string& words);

}  // namespace planum::dxf
