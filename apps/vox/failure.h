#pragma once

#include <string>

namespace vox::app {

/// Why a run failed.
struct Failure {
  std::string message;  ///< one line
  int code;             ///< exit code of the program
};

/// Describes the exception that is being handled.
Failure currentFailure();

}  // namespace vox::app
