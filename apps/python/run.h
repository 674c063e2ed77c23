#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <utility>

namespace vox {
class Progress;
}

namespace vox::python {

/// Makes the exceptions of the module: Error, UsageError, InputError, MeshError, LimitError,
/// IoError, CheckFailed, Cancelled. Errors of libvox become these, with the same line.
void addErrors(pybind11::module_& module);

/// A text of libvox; bytes that are no UTF-8 become \xNN.
pybind11::str text(const std::string& bytes);

/// Calls work on a thread of its own, without the interpreter's lock, and waits. Meanwhile the
/// calling thread handles signals and calls the callback. If one of these raises an exception, the
/// run is cancelled, and the exception passed on once it has stopped.
/// @param callback  None, or callable with a fraction, 0 to 1, and the name of a stage. If it
///   returns False the run is cancelled.
/// @throws Cancelled  the callback wanted it; and all that work throws: errors of libvox, or
///   std::runtime_error for any other
void runWatched(const pybind11::object& callback, const std::function<void(Progress&)>& work);

/// The same for work with a result that has no progress and cannot be cancelled.
template <class Work>
auto runUnwatched(Work&& work) {
  decltype(work()) result;
  runWatched(pybind11::none(), [&](Progress&) { result = work(); });
  return result;
}

}  // namespace vox::python
