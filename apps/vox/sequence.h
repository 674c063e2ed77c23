#pragma once

#include <string>
#include <vector>

namespace vox::app {

/// One conversion of a sequence.
struct Frame {
  std::string input;
  std::string output;
};

/// The conversions of a command line.
///
/// Usually a single input is a single conversion. But if its name holds a pattern (a run of #, one
/// for each digit of the frame number, or %d or %04d) and no file has that very name, every file
/// that fits the pattern is a conversion, in the order of the numbers. Several inputs are one
/// conversion each, numbered from 1. The output of several conversions must have a place for the
/// number: out.####.vdb.
///
/// @param output  empty if nothing is to be written
/// @throws UsageError  several inputs, but no place for a number in the output, or more than one
/// @throws InputError  no file fits a pattern
std::vector<Frame> framesOf(const std::vector<std::string>& inputs, const std::string& output);

}  // namespace vox::app
