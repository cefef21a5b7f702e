#include "python/call.h"

#include <string>

#include "lowlap/core/internal/format.h"

namespace lowlap::python {
namespace {

py::object ErrorType() {
  return py::module_::import("lowlap._base").attr("Error");
}

const char* LevelName(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return "debug";
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
  }
  return "unknown";
}

}  // namespace

void Raise(const Error& error) {
  const py::object type = ErrorType();
  // Python's strings hold no bytes that are not UTF-8.
  const py::object value =
      type(ErrorCodeName(error.code), Printable(error.message),
           Printable(error.file), Printable(error.place));
  PyErr_SetObject(type.ptr(), value.ptr());
  throw py::error_already_set();
}

void RaiseIfError(const Status& status) {
  if (!status) Raise(status.error());
}

bool IsError(const py::error_already_set& exception) {
  return exception.matches(ErrorType());
}

Error ErrorOf(const py::error_already_set& exception) {
  const py::object& value = exception.value();
  const auto text = [&](const char* name) {
    return py::str(value.attr(name)).cast<std::string>();
  };
  Error error{ErrorCode::kNumerical, text("message"), text("file"),
              text("place")};
  const std::string code = text("code");
  for (int c = 0; c <= static_cast<int>(ErrorCode::kCancelled); ++c) {
    if (code == ErrorCodeName(static_cast<ErrorCode>(c))) {
      error.code = static_cast<ErrorCode>(c);
    }
  }
  return error;
}

Call::Call(py::object progress, py::object log, int threads, std::uint64_t seed)
    : progress_(std::move(progress)), log_(std::move(log)) {
  context_.num_threads = threads;
  context_.seed = seed;
  context_.progress = [this](const std::string& stage, std::size_t done,
                             std::size_t total) {
    return OnProgress(stage, done, total);
  };
  context_.log = [this](LogLevel level, const std::string& message) {
    if (log_.is_none() && level != LogLevel::kWarning) return;
    CallBack([&] {
      if (!log_.is_none()) {
        log_(LevelName(level), message);
      } else if (PyErr_WarnEx(PyExc_UserWarning, message.c_str(), 1) != 0) {
        throw py::error_already_set();
      }
      return true;
    });
  };
}

bool Call::CallBack(const std::function<bool()>& body) {
  if (stopped_) return false;
  const py::gil_scoped_acquire acquire;
  try {
    if (body()) return true;
  } catch (...) {
    // It must not cross the library; Run raises it again.
    if (!raised_) raised_ = std::current_exception();
  }
  stopped_ = true;
  return false;
}

bool Call::OnProgress(const std::string& stage, std::size_t done,
                      std::size_t total) {
  return CallBack([&] {
    // Python's signal handlers run here (in the main thread): Ctrl-C stops.
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress_.is_none()) return true;
    return !progress_(stage, done, total).is(py::bool_(false));
  });
}

}  // namespace lowlap::python
