#include "lowlap/core/internal/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "lowlap/core/internal/format.h"

namespace lowlap {

struct Hash128::State {
  XXH3_state_t hash;
};

Hash128::Hash128() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}

Hash128::~Hash128() = default;

void Hash128::AddBytes(std::string_view bytes) {
  XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
}

void Hash128::Add(std::string_view text) {
  Add(static_cast<std::uint64_t>(text.size()));
  AddBytes(text);
}

void Hash128::Add(const Value& value) {
  Add(value.high);
  Add(value.low);
}

Hash128::Value Hash128::value() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->hash);
  return {hash.high64, hash.low64};
}

std::string ToHex(const Hash128::Value& value) {
  return Format("%016llx%016llx", static_cast<unsigned long long>(value.high),
                static_cast<unsigned long long>(value.low));
}

}  // namespace lowlap
