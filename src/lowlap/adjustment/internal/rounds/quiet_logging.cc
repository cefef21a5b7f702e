#include "lowlap/adjustment/internal/rounds/quiet_logging.h"

#include <glog/logging.h>

#include <mutex>

namespace lowlap {
namespace {

std::mutex g_mutex;
int g_depth = 0;
int g_saved_level = 0;

}  // namespace

QuietLogging::QuietLogging() {
  const std::lock_guard<std::mutex> lock(g_mutex);
  if (g_depth++ > 0) return;
  g_saved_level = FLAGS_minloglevel;
  FLAGS_minloglevel = google::GLOG_FATAL;
}

QuietLogging::~QuietLogging() {
  const std::lock_guard<std::mutex> lock(g_mutex);
  if (--g_depth == 0) FLAGS_minloglevel = g_saved_level;
}

}  // namespace lowlap
