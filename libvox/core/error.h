#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace vox {

/// `text` with its control characters, line ends among them, replaced by ?.
std::string onOneLine(std::string text);

/// Base of everything libvox throws on purpose. `what()` is one line that names the file, line or
/// element, says what is wrong and, where it helps, what to do.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string message) : std::runtime_error(onOneLine(std::move(message))) {}

  /// Exit code of a command that fails with this error (DESIGN section 10).
  virtual int exitCode() const noexcept = 0;
};

/// A call or command line that asks for something impossible: a negative voxel size.
class UsageError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 2; }
};

/// An input file or scene that cannot be read or means nothing.
class InputError : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 3; }
};

/// A mesh that breaks a rule the algorithm needs: an index out of range, three faces on an edge.
class MeshError : public InputError {
 public:
  using InputError::InputError;
};

/// The task is valid but does not fit: memory, coordinate range, number of elements.
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
