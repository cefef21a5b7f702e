#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "python/bindings.h"

namespace lowlap::python {

/// Raises lowlap.Error.
[[noreturn]] void Raise(const Error& error);
void RaiseIfError(const Status& status);

/// Whether the exception is a lowlap.Error, and what it says.
bool IsError(const py::error_already_set& exception);
Error ErrorOf(const py::error_already_set& exception);

/// The value, or lowlap.Error.
template <class T>
T ValueOf(Result<T> result) {
  if (!result) Raise(result.error());
  return std::move(*result);
}

/// One call from Python into long work: what the work gets from its host, and
/// what the callbacks of the host raise. Lives on the stack of the calling
/// thread, beside everything that refers to it.
class Call {
 public:
  /// `progress(stage, done, total)` and `log(level, message)`, or None:
  /// warnings then go to Python's module of this name.
  Call(py::object progress, py::object log, int threads, std::uint64_t seed);
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  const RunContext& context() const { return context_; }

  /// The value of `work()`, which runs without the interpreter's lock. Raises
  /// what a callback has raised (KeyboardInterrupt, too), else the error of the
  /// result.
  template <class Work>
  auto Run(const Work& work) {
    auto result = [&] {
      const py::gil_scoped_release release;
      return work();
    }();
    if (raised_) std::rethrow_exception(raised_);
    if (!result) Raise(result.error());
    if constexpr (!std::is_void_v<typename decltype(result)::value_type>) {
      return std::move(*result);
    }
  }

  /// Calls back into Python, from any thread. False if the work is to stop:
  /// `body` returned false or raised, now or before.
  bool CallBack(const std::function<bool()>& body);

 private:
  bool OnProgress(const std::string& stage, std::size_t done,
                  std::size_t total);

  py::object progress_;
  py::object log_;
  RunContext context_;
  std::atomic<bool> stopped_{false};
  std::exception_ptr raised_;  // under the interpreter's lock
};

}  // namespace lowlap::python
