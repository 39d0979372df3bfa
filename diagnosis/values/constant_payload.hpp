#pragma once

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Payload (kg) of a run whose log has no column of it: the same for the whole run.
inline double constant_payload_kg(const Run& run) {
  return run.payload.empty() ? 0.0 : run.payload.front().payload_kg;
}

}  // namespace joulepath
