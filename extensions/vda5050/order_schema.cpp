#include "extensions/vda5050/order.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"

namespace joulepath {
namespace {

constexpr Range kHalfTurn{-3.1416, 3.1416};
constexpr Range kCoordinate_m{-kFarthest_m, kFarthest_m};
constexpr Range kSpeed{1e-3, 1e4};

Schema action_schema() {
  return open(map({required("actionType", text()), optional("actionId", text()),
                   required("blockingType", choice({"NONE", "SINGLE", "SOFT", "HARD"})),
                   optional("actionParameters", list(open(map({required("key", text())}))),
                            "a parameter `duration` says how long the action takes, in seconds")}));
}

Schema deviation_schema() {
  return any_of({number(kNotNegative),
                 open(map({required("a", number(kNotNegative)), required("b", number(kNotNegative))}))});
}

Schema position_schema() {
  return open(
      map({required("x", number(kCoordinate_m), "m"), required("y", number(kCoordinate_m), "m"),
           optional("theta", number(kHalfTurn), "rad"), optional("mapId", text()),
           optional("allowedDeviationXY", deviation_schema(), "m; an ellipse {a, b, theta} since version 3"),
           optional("allowedDeviationTheta", number(kNotNegative), "rad")}));
}

Schema node_schema() {
  return open(map({required("nodeId", text()), required("sequenceId", integer(kNotNegative)),
                   required("released", boolean()), required("nodePosition", position_schema()),
                   required("actions", list(action_schema()))}));
}

Schema trajectory_schema() {
  const Schema point =
      open(map({required("x", number(kCoordinate_m), "m"), required("y", number(kCoordinate_m), "m"),
                optional("weight", number(kPositive), "default 1")}));
  return open(map({optional("degree", integer({1, RationalBezier::kMostDegree}), "default 1"),
                   optional("knotVector", list(number())), required("controlPoints", list(point, 2))}));
}

Schema edge_schema() {
  return open(
      map({required("edgeId", text()), required("sequenceId", integer(kNotNegative)),
           required("released", boolean()), optional("startNodeId", text()), optional("endNodeId", text()),
           optional("maxSpeed", number(kSpeed), "m/s, versions 1.1 and 2"),
           optional("maximumSpeed", number(kSpeed), "m/s, version 3"),
           optional("maxRotationSpeed", number(kSpeed), "rad/s"),
           optional("maximumRotationSpeed", number(kSpeed), "rad/s"),
           optional("orientation", number(kHalfTurn), "rad"),
           optional("orientationType", choice({"TANGENTIAL", "GLOBAL"})),
           optional("trajectory", trajectory_schema(), "a NURBS; absent: straight"),
           required("actions", list(action_schema()))}));
}

}  // namespace

Schema order_schema() {
  return open(map({required("version", text(), "1.1, 2.x or 3.x"), optional("orderId", text()),
                   required("nodes", list(node_schema(), 1)), required("edges", list(edge_schema()))}));
}

}  // namespace joulepath
