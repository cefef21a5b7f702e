#pragma once

#include "lowlap/core/ids.h"

namespace lowlap {

// For nlohmann::json: arrays.

template <class Json>
void to_json(Json& json, const ViewPair& views) {
  json = {views.first, views.second};
}
template <class Json>
void to_json(Json& json, const ViewTriplet& views) {
  json = {views.first, views.middle, views.last};
}

}  // namespace lowlap
