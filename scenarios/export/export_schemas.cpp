#include "scenarios/result_files/output_schemas.hpp"

namespace joulepath {
namespace {

Schema at_time_schema() {
  return open(map({required("duration_s", number()), required("energy_J", number()),
                   required("optimum_J", number(), "least energy of the same path in the same time"),
                   required("lost_J", number()), required("lost_percent", number(), "of energy_J")}));
}

Schema edge_schema() {
  return open(
      map({required("leg", integer(kNotNegative), "counted from 0"), required("to", text()),
           required("edge", text(), "of an order; else empty"),
           required("kind", choice({"drive", "turn", "wait", "dwell", "prescribed"})),
           required("start_s", number()), required("duration_s", number()), required("distance_m", number()),
           required("turned_rad", number()), required("payload_kg", number()), required("energy_J", number()),
           required("motion_energy_J", number(), "without standby")}));
}

}  // namespace

std::vector<Schema::Key> loss_keys() {
  return {required("own_time", at_time_schema(), "the controller at its own duration"),
          required("plan_time", nullable(at_time_schema()),
                   "with a wait until the plan's end; null where the controller is later"),
          required("broken_limit", text(), "the limit that the controller would exceed; empty: none")};
}

Schema loss_schema() {
  std::vector<Schema::Key> keys = loss_keys();
  keys.insert(keys.begin(), {optional("schema", text(), "joulepath/loss/1"), required("of", text())});
  return open(map(std::move(keys)));
}

Schema edges_schema() {
  return open(map({optional("schema", text(), "joulepath/edges/1"), optional("mission", text()),
                   required("energy_J", number(), "of the plan: the sum over the edges"),
                   required("duration_s", number()), required("edges", list(edge_schema()))}));
}

}  // namespace joulepath
