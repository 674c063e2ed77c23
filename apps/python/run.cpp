// Work without the interpreter's lock, and errors as Python's exceptions.

#include "apps/python/run.h"

#include "apps/vox/failure.h"
#include "apps/vox/verify.h"
#include "libvox/core/error.h"
#include "libvox/core/progress.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace vox::python {
namespace {

namespace py = pybind11;

// The classes live as long as the process.
PyObject* gError;
PyObject* gUsageError;
PyObject* gInputError;
PyObject* gMeshError;
PyObject* gLimitError;
PyObject* gIoError;
PyObject* gCheckFailed;
PyObject* gCancelled;

PyObject* classOf(const Error& error) {
  if (dynamic_cast<const MeshError*>(&error) != nullptr) return gMeshError;
  if (dynamic_cast<const InputError*>(&error) != nullptr) return gInputError;
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return gUsageError;
  if (dynamic_cast<const LimitError*>(&error) != nullptr) return gLimitError;
  if (dynamic_cast<const IoError*>(&error) != nullptr) return gIoError;
  if (dynamic_cast<const Cancelled*>(&error) != nullptr) return gCancelled;
  if (dynamic_cast<const app::CheckFailed*>(&error) != nullptr) return gCheckFailed;
  return gError;
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    PyErr_SetObject(classOf(error), text(error.what()).ptr());
  }
}

PyObject* addError(py::module_& module, const char* name, const char* doc, py::object bases) {
  const std::string full = std::string("vox.") + name;
  PyObject* const made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, py::reinterpret_borrow<py::object>(made));
  return made;
}

/// Throws what stopped a run as an error of libvox, as the program would name it.
[[noreturn]] void rethrowAsError(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error&) {
    throw;
  } catch (...) {
    const app::Failure failure = app::currentFailure();
    if (failure.code == LimitError("").exitCode()) throw LimitError(failure.message);
    if (failure.code == IoError("").exitCode()) throw IoError(failure.message);
    throw std::runtime_error(failure.message);
  }
}

/// What the thread at work and the thread that waits tell each other.
class Watch {
 public:
  struct News {
    bool isDone = false;
    bool hasProgress = false;
    double fraction = 0;
    const char* stage = "";
  };

  void report(double fraction, const char* stage) {
    const std::scoped_lock lock(mutex_);
    news_.hasProgress = true;
    news_.fraction = fraction;
    news_.stage = stage;
    changed_.notify_one();
  }
  void finish() {
    const std::scoped_lock lock(mutex_);
    news_.isDone = true;
    changed_.notify_one();
  }
  /// Waits for news, but not longer than signals may wait.
  News wait() {
    constexpr std::chrono::milliseconds kLongest(50);
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLongest, [&] { return news_.isDone || news_.hasProgress; });
    return std::exchange(news_, {news_.isDone, false, 0, ""});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  News news_;
};

void tell(const py::object& callback, const Watch::News& news, Progress& progress) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!news.hasProgress) return;
  if (callback(news.fraction, news.stage).ptr() == Py_False) progress.cancel();
}

/// Waits for the end of a run. Returns the exception of a signal handler or of the callback.
std::exception_ptr watch(Watch& watched, const py::object& callback, Progress& progress) {
  std::exception_ptr raised;
  for (bool isDone = false; !isDone;) {
    Watch::News news;
    {
      const py::gil_scoped_release released;
      news = watched.wait();
    }
    isDone = news.isDone;
    if (raised) continue;
    try {
      tell(callback, news, progress);
    } catch (...) {
      raised = std::current_exception();
      progress.cancel();
    }
  }
  return raised;
}

}  // namespace

void addErrors(py::module_& module) {
  const auto base = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  const auto alsoA = [&](PyObject* type) { return py::make_tuple(base(gError), base(type)); };
  gError = addError(module, "Error", "Base of the errors of vox. The message is one line.",
                    base(PyExc_Exception));
  gUsageError = addError(module, "UsageError", "An invalid option.", alsoA(PyExc_ValueError));
  gInputError = addError(module, "InputError", "A file or array that is invalid or unreadable.",
                         alsoA(PyExc_ValueError));
  gMeshError = addError(module, "MeshError",
                        "A mesh with an element that is wrong. Elements are counted from 0.",
                        base(gInputError));
  gLimitError =
      addError(module, "LimitError",
               "Valid input that exceeds a limit: memory, coordinates, counts.", base(gError));
  gIoError = addError(module, "IoError", "A file that cannot be written.", alsoA(PyExc_OSError));
  gCheckFailed = addError(module, "CheckFailed", "verify=True has found a fault.", base(gError));
  gCancelled = addError(module, "Cancelled", "The progress callback returned False.", base(gError));
  py::register_exception_translator(translate);
}

py::str text(const std::string& bytes) {
  PyObject* const made =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "backslashreplace");
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(made);
}

void runWatched(const py::object& callback, const std::function<void(Progress&)>& work) {
  if (!callback.is_none() && PyCallable_Check(callback.ptr()) == 0)
    throw py::type_error("progress must be a function of a fraction and the name of a stage");
  Watch watched;
  Progress progress(callback.is_none()
                        ? Progress::Callback()
                        : [&](double part, const char* stage) { watched.report(part, stage); });
  std::exception_ptr failed;
  std::thread thread;
  try {
    thread = std::thread([&] {
      try {
        work(progress);
      } catch (...) {
        failed = std::current_exception();
      }
      watched.finish();
    });
  } catch (const std::system_error&) {
    throw LimitError("no memory for another thread; use fewer threads or allow more memory");
  }
  const std::exception_ptr raised = watch(watched, callback, progress);
  {
    const py::gil_scoped_release released;
    thread.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failed) rethrowAsError(failed);
}

}  // namespace vox::python
