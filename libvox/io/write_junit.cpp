// JUnit's XML, the part that Jenkins, GitLab, GitHub and others read alike.

#include "libvox/io/write_junit.h"

#include "libvox/core/error.h"
#include "libvox/core/markup.h"

#include <algorithm>
#include <string_view>

namespace vox {
namespace {

std::string attribute(const char* name, std::string_view value) {
  return std::string(" ") + name + '=' + escapedValue(value);
}

std::string counts(const JunitSuite& suite) {
  const auto count = [&](JunitCase::Result result) {
    return std::to_string(
        std::count_if(suite.cases.begin(), suite.cases.end(),
                      [&](const JunitCase& one) { return one.result == result; }));
  };
  return attribute("tests", std::to_string(suite.cases.size())) +
         attribute("failures", count(JunitCase::Result::kFailed)) +
         attribute("errors", count(JunitCase::Result::kError));
}

void writeCase(std::ostream& out, const JunitSuite& suite, const JunitCase& one) {
  out << "    <testcase" << attribute("classname", suite.name) << attribute("name", one.name);
  if (one.result == JunitCase::Result::kPassed) {
    out << "/>\n";
    return;
  }
  const char* const element = one.result == JunitCase::Result::kError ? "error" : "failure";
  const std::string_view message = std::string_view(one.text).substr(0, one.text.find('\n'));
  out << ">\n      <" << element << attribute("message", message) << '>' << escaped(one.text)
      << "</" << element << ">\n    </testcase>\n";
}

}  // namespace

void writeJunit(std::ostream& out, const JunitSuite& suite) {
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" << counts(suite)
      << ">\n  <testsuite" << attribute("name", suite.name) << counts(suite)
      << attribute("skipped", "0") << ">\n";
  for (const JunitCase& one : suite.cases) writeCase(out, suite, one);
  out << "  </testsuite>\n</testsuites>\n";
  if (!out.flush()) throw IoError("the report cannot be written; is the disk full?");
}

}  // namespace vox
