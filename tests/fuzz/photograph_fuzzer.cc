// Photographs: their size, pixels, thumbnail and EXIF data.
#include "fuzz_input.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/features/internal/thumbnail.h"
#include "lowlap/pipeline/internal/measure/exif.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string bytes(fuzz::Bytes(data, size));
  const auto pixels = DecodeImageSize(bytes, "a.jpg");
  fuzz::CheckResult(pixels, "a.jpg");
  fuzz::CheckResult(DecodeGrayImage(bytes, "a.jpg"), "a.jpg");
  fuzz::CheckResult(MakeThumbnail(bytes, 64, "a.jpg"), "a.jpg");
  const fuzz::InputFolder folder(bytes);
  fuzz::CheckResult(
      ReadExif(folder.File(), pixels.value_or(ImageSize{640, 480})),
      folder.File());
  return 0;
}
