// Calibrations and true cameras.
#include "fuzz_input.h"
#include "third_party_adapters/internal/camera_files.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace {

lowlap::Scene NamedViews() {
  lowlap::Scene scene;
  for (int n = 0; n < 3; ++n) {
    lowlap::View& view = scene.views[n];
    view.filename = "000" + std::to_string(n) + ".jpg";
    view.pose_id = n;
  }
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string_view bytes = fuzz::Bytes(data, size);
  fuzz::CheckResult(strecha::ParseCalibrationMatrix(bytes, "K.txt"), "K.txt");
  fuzz::CheckResult(strecha::ParseCamera(bytes, "a.camera"), "a.camera");
  const fuzz::InputFolder folder(bytes);
  static const Scene scene = NamedViews();
  fuzz::CheckResult(ReadGroundTruth(folder.path(), scene), folder.path());
  fuzz::CheckResult(ReadIntrinsicSource(folder.File()), folder.File());
  return 0;
}
