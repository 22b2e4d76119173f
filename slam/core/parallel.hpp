#pragma once

#include <cstddef>
#include <functional>

#include "slam/core/progress.hpp"

namespace planum {

/// Threads that parallel_for uses; 0: as many as the machine has.
void set_thread_count(int threads);
int thread_count();

/// Calls body(begin, end) for consecutive blocks of [0, count), on all threads, in any order.
/// Blocks do not depend on the number of threads, so a body that writes to slot i, or to a result
/// of its block that is reduced in order afterwards, gives the same result for any number of
/// threads. The exception of the first (lowest) failing block is thrown after all threads have
/// stopped.
void parallel_for(std::size_t count, std::size_t block_size,
                  const std::function<void(std::size_t begin, std::size_t end)>& body,
                  const Progress& progress = {});

}  // namespace planum
