#include "slam/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <omp.h>

namespace planum {

void set_thread_count(int threads) {
  omp_set_num_threads(threads > 0 ? threads : omp_get_num_procs());
}

int thread_count() { return omp_get_max_threads(); }

void parallel_for(std::size_t count, std::size_t block_size,
                  const std::function<void(std::size_t, std::size_t)>& body,
                  const Progress& progress) {
  const std::size_t step = std::max<std::size_t>(block_size, 1);
  const std::size_t blocks = (count + step - 1) / step;
  std::atomic<std::size_t> finished = 0;
  std::atomic<std::size_t> first_failed = std::numeric_limits<std::size_t>::max();
  std::exception_ptr failure;
  std::mutex failure_mutex;
#pragma omp parallel for schedule(dynamic, 1) if (blocks > 1)
  for (std::size_t block = 0; block < blocks; ++block) {
    // Lower blocks still run, so that the error that is reported does not depend on timing.
    if (block > first_failed) continue;
    try {
      body(block * step, std::min(count, (block + 1) * step));
      progress.report(std::min(count, (finished += 1) * step), count);
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (block < first_failed) {
        first_failed = block;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace planum
