// What a study that was stopped has left.
#include "fuzz_input.h"
#include "lowlap/study/internal/result_log.h"
#include "lowlap/study/internal/robustness/table.h"
#include "lowlap/study/internal/subset_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const fuzz::InputFolder folder(fuzz::Bytes(data, size));
  static const auto plan = PlanRobustnessStudy({});
  RobustnessStudy study = plan.value();
  const auto log =
      ResultLog::Open(folder.File(), "", [&](const std::string& line) {
        const bool is_cell = AddJsonLine(line, &study);
        const auto subset = SubsetFromJsonLine(line);
        if (subset) ToJsonLine(*subset);
        return is_cell || subset;
      });
  fuzz::CheckResult(log, folder.File());
  TrialsCsv(study);
  CurvesCsv(study);
  return 0;
}
