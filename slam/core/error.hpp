#pragma once

#include <exception>
#include <string>

namespace planum {

/// What kind of trouble an Error is; the program's exit code follows from it.
enum class ErrorKind {
  usage,        ///< the command line is wrong
  input,        ///< a file or a value in it is wrong
  no_result,    ///< the input is fine but gives nothing usable, e.g. scans that do not connect
  environment,  ///< disk full, no permission, ...
};

/// The one exception of the project. It gains context from the inside outwards:
/// `register: scan 007: raw/scan007.3d:12: expected 3 numbers, got 2`.
class Error : public std::exception {
 public:
  explicit Error(std::string message, ErrorKind kind = ErrorKind::input)
      : message_(std::move(message)), kind_(kind) {}

  /// Puts `context + ": "` in front of the message. Use as
  /// `catch (Error& e) { e.add_context("scan 007"); throw; }`.
  void add_context(const std::string& context) { message_ = context + ": " + message_; }

  const char* what() const noexcept override { return message_.c_str(); }
  ErrorKind kind() const noexcept { return kind_; }

 private:
  std::string message_;
  ErrorKind kind_;
};

}  // namespace planum
