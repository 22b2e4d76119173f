#pragma once

#include <string>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {

/// What an action complains about; empty if it does not.
template <typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

/// Runs an action on a number of threads, then returns to all.
template <typename Action>
auto with_threads(int threads, const Action& action) {
  set_thread_count(threads);
  auto result = action();
  set_thread_count(0);
  return result;
}

}  // namespace planum
