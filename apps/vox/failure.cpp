// Errors as a line and an exit code.

#include "apps/vox/failure.h"

#include "libvox/core/error.h"

#include <ios>
#include <new>
#include <stdexcept>
#include <string_view>

namespace vox::app {
namespace {

constexpr int kLimitCode = 4;
constexpr int kIoCode = 5;
constexpr int kInternalCode = 70;  // a bug of ours: EX_SOFTWARE

/// TBB says in words alone that a thread could not be started, for want of memory mostly.
bool isLackOfThreads(const std::exception& error) {
  return std::string_view(error.what()).starts_with("pthread_create has failed");
}

}  // namespace

Failure currentFailure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.what(), error.exitCode()};
  } catch (const std::bad_alloc&) {
    return {"out of memory; use a smaller --dim or a larger --voxel-size", kLimitCode};
  } catch (const std::ios_base::failure& error) {
    return {onOneLine(error.what()), kIoCode};
  } catch (const std::exception& error) {
    if (isLackOfThreads(error))
      return {"no memory for another thread; use fewer --threads or allow more memory", kLimitCode};
    return {onOneLine(std::string("internal error, please report it: ") + error.what()),
            kInternalCode};
  }
}

}  // namespace vox::app
