#include "tools/workflow/peak_memory.hpp"

#include <fstream>
#include <string>

namespace planum {

// proc(5): writing 5 to clear_refs resets VmHWM of /proc/self/status.
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5\n"; }

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
  }
  return 0;
}

}  // namespace planum
