#pragma once

namespace planum {

/// Starts a new measurement of the largest resident size of this process, where the system allows.
void reset_peak_memory();

/// The largest resident size since then, in MB (2^20 bytes); 0 where it is unknown.
double peak_memory_mb();

}  // namespace planum
