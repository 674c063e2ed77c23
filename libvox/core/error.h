#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace vox {

/// `text` with all control characters, including line ends, replaced by '?'.
std::string onOneLine(std::string text);

/// Base of all exceptions of libvox itself. `what()` is one line: it names the file, line or
/// element, says what is wrong and, where it helps, what to do.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string message) : std::runtime_error(onOneLine(std::move(message))) {}

  /// Exit code of a command that fails with this error (DESIGN section 15).
  virtual int exitCode() const noexcept = 0;
};

/// An invalid argument or option, such as a negative voxel size.
class UsageError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 2; }
};

/// An input file or scene that cannot be read, or whose content is invalid.
class InputError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 3; }
};

/// A mesh that breaks a precondition of an algorithm: an index out of range, three faces on an
/// edge.
class MeshError : public InputError {
 public:
  using InputError::InputError;
};

/// Valid input that exceeds a limit: memory, coordinate range, number of elements.
class LimitError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 4; }
};

/// Output could not be written.
class IoError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 5; }
};

}  // namespace vox
