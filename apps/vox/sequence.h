#pragma once

#include <string>
#include <vector>

namespace vox::app {

/// One conversion of a sequence.
struct Frame {
  std::string input;
  std::string output;
};

/// The conversions that a command line asks for.
///
/// A single input is one of them, as it stands, unless its file name holds a run of # (frame
/// numbers of at least so many digits) or %d, %04d, and there is no file of that very name: then
/// every file that fits is one, by number. Of several inputs each is one, numbered from 1. The
/// output of several must have a place for the number: out.####.vdb.
///
/// @param output  may be empty: nothing is to be written
/// @throws UsageError  several inputs, but no place for a number in the output, or more than one
/// @throws InputError  no file fits a pattern
std::vector<Frame> framesOf(const std::vector<std::string>& inputs, const std::string& output);

}  // namespace vox::app
