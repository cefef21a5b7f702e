#include "third_party_adapters/openmvg/internal/archive_reader.h"

#include <cmath>

namespace lowlap::openmvg {

void ArchiveReader::Doubles(double* values, std::size_t length) {
  const std::size_t place = offset_;
  const std::uint64_t stored = Scalar<std::uint64_t>();
  if (stored != length) {
    FailAt(place, "a vector of " + std::to_string(length) +
                      " numbers is expected, not of " + std::to_string(stored));
  }
  for (std::size_t n = 0; n < length; ++n) {
    const std::size_t number_place = offset_;
    values[n] = Scalar<double>();
    if (!std::isfinite(values[n])) {
      FailAt(number_place, "the number is not finite");
    }
  }
}

}  // namespace lowlap::openmvg
