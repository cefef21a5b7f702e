#include "lowlap/features/internal/jpeg_damage.h"

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
// After what declares FILE, which jpeglib.h names.
#include <jerror.h>
#include <jpeglib.h>

namespace lowlap {
namespace {

constexpr int kMaxScans = 100;
// Writers leave a few bytes between the image and its end; an image that damage
// completes too early leaves far more.
constexpr int kFewBytes = 64;

// What libjpeg calls back; it knows the parts alone. Nothing with a destructor
// may live between the jump and its landing.
struct Watch {
  const std::string* bytes = nullptr;
  jpeg_error_mgr errors;
  jpeg_progress_mgr progress;
  std::jmp_buf stop;
  bool is_damaged = false;
  char what[JMSG_LENGTH_MAX] = "";
};

Watch& WatchOf(j_common_ptr decoder) {
  return *static_cast<Watch*>(decoder->client_data);
}

void Note(j_common_ptr decoder) {
  Watch& watch = WatchOf(decoder);
  if (watch.is_damaged) return;
  watch.is_damaged = true;
  decoder->err->format_message(decoder, watch.what);
}

// Whether data were left when the image was complete: more than a few, and no
// padding. Damaged data may code an image too early.
bool IsDataLeft(j_common_ptr decoder) {
  const jpeg_source_mgr& source =
      *reinterpret_cast<j_decompress_ptr>(decoder)->src;
  const std::string& bytes = *WatchOf(decoder).bytes;
  const auto end = static_cast<std::size_t>(
      reinterpret_cast<const char*>(source.next_input_byte) - bytes.data());
  const auto num = static_cast<std::size_t>(decoder->err->msg_parm.i[0]);
  if (num <= kFewBytes || num > end) return num > end;
  return std::any_of(bytes.begin() + static_cast<std::ptrdiff_t>(end - num),
                     bytes.begin() + static_cast<std::ptrdiff_t>(end),
                     [](char byte) { return byte != '\0' && byte != '\xff'; });
}

// Of the warnings (level -1), those that cost a part of the image.
void OnMessage(j_common_ptr decoder, int level) {
  if (level >= 0) return;
  switch (decoder->err->msg_code) {
    case JWRN_ADOBE_XFORM:
    case JWRN_JFIF_MAJOR:
    case JWRN_NOT_SEQUENTIAL:
    case JWRN_TOO_MUCH_DATA:
      return;
    case JWRN_EXTRANEOUS_DATA:
      if (IsDataLeft(decoder)) Note(decoder);
      return;
    default:
      Note(decoder);
  }
}

[[noreturn]] void OnError(j_common_ptr decoder) {
  Note(decoder);
  std::longjmp(WatchOf(decoder).stop, 1);
}

void OnProgress(j_common_ptr decoder) {
  if (reinterpret_cast<j_decompress_ptr>(decoder)->input_scan_number >
      kMaxScans) {
    std::longjmp(WatchOf(decoder).stop, 1);
  }
}

void Decode(const std::string& bytes, Watch* watch) {
  jpeg_decompress_struct decoder;
  decoder.client_data = watch;
  decoder.err = jpeg_std_error(&watch->errors);
  watch->errors.emit_message = OnMessage;
  watch->errors.output_message = [](j_common_ptr) {};
  watch->errors.error_exit = OnError;
  if (setjmp(watch->stop) == 0) {
    jpeg_create_decompress(&decoder);
    watch->progress.progress_monitor = OnProgress;
    decoder.progress = &watch->progress;
    jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()),
                 static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&decoder, TRUE);
    decoder.scale_num = 1;
    decoder.scale_denom = 8;
    jpeg_start_decompress(&decoder);
    const JSAMPARRAY row = decoder.mem->alloc_sarray(
        reinterpret_cast<j_common_ptr>(&decoder), JPOOL_IMAGE,
        decoder.output_width * decoder.output_components, 1);
    while (decoder.output_scanline < decoder.output_height) {
      jpeg_read_scanlines(&decoder, row, 1);
    }
    jpeg_finish_decompress(&decoder);
  }
  jpeg_destroy_decompress(&decoder);
}

}  // namespace

std::optional<std::string> JpegDamage(const std::string& bytes) {
  if (bytes.compare(0, 2, "\xff\xd8") != 0) return std::nullopt;
  Watch watch;
  watch.bytes = &bytes;
  Decode(bytes, &watch);
  if (!watch.is_damaged) return std::nullopt;
  return std::string(watch.what);
}

}  // namespace lowlap
