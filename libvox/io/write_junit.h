#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace vox {

/// A test and how it ended.
struct JunitCase {
  enum class Result { kPassed, kFailed, kError };

  std::string name;
  Result result = Result::kPassed;
  std::string text = {};  ///< why; its first line is the message
};

struct JunitSuite {
  std::string name;
  std::vector<JunitCase> cases;
};

/// Writes the XML in which JUnit reports tests and which CI systems show: one suite. Texts may have
/// any bytes: what XML cannot hold (control characters, bytes that are not UTF-8) becomes U+FFFD.
/// There are no times, so that equal results give equal bytes.
/// @throws IoError  the stream fails
void writeJunit(std::ostream& out, const JunitSuite& suite);

}  // namespace vox
