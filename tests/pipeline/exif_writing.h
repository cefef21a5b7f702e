#pragma once

#include <libexif/exif-data.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>

namespace lowlap::testing {

/// Puts EXIF data into a JPEG file: lengths and resolutions as rational
/// numbers, everything else as short integers.
inline void AddExif(const std::map<ExifTag, double>& tags,
                    const std::string& jpeg) {
  ExifData* data = exif_data_new();
  exif_data_set_byte_order(data, EXIF_BYTE_ORDER_INTEL);
  for (const auto& [tag, value] : tags) {
    ExifEntry* entry = exif_entry_new();
    entry->tag = tag;
    exif_content_add_entry(
        data->ifd[tag == EXIF_TAG_ORIENTATION ? EXIF_IFD_0 : EXIF_IFD_EXIF],
        entry);
    const bool rational = tag == EXIF_TAG_FOCAL_LENGTH ||
                          tag == EXIF_TAG_FOCAL_PLANE_X_RESOLUTION;
    entry->format = rational ? EXIF_FORMAT_RATIONAL : EXIF_FORMAT_SHORT;
    entry->components = 1;
    entry->size = exif_format_get_size(entry->format);
    ExifMem* memory = exif_mem_new_default();
    entry->data =
        static_cast<unsigned char*>(exif_mem_alloc(memory, entry->size));
    exif_mem_unref(memory);
    if (rational) {
      exif_set_rational(entry->data, EXIF_BYTE_ORDER_INTEL,
                        {static_cast<ExifLong>(value * 1000), 1000});
    } else {
      exif_set_short(entry->data, EXIF_BYTE_ORDER_INTEL,
                     static_cast<ExifShort>(value));
    }
    exif_entry_unref(entry);
  }
  unsigned char* bytes = nullptr;
  unsigned size = 0;
  exif_data_save_data(data, &bytes, &size);
  exif_data_unref(data);
  std::ostringstream old;
  old << std::ifstream(jpeg, std::ios::binary).rdbuf();
  std::ofstream out(jpeg, std::ios::binary);
  out << "\xff\xd8\xff\xe1" << static_cast<char>((size + 2) >> 8)
      << static_cast<char>(size + 2);
  out.write(reinterpret_cast<const char*>(bytes), size);
  out << old.str().substr(2);
  std::free(bytes);
}

}  // namespace lowlap::testing
