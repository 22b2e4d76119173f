#pragma once

namespace planum {

/// Understands the arguments and does what they ask for. Throws Error(usage) for arguments that
/// make no sense, naming what was probably meant.
void command_line(int argc, const char* const* argv);

}  // namespace planum
