#include "diagnosis/checks/odd_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {
namespace {

bool is_odd(const OddLaws& laws, const Relations& run, std::size_t law) {
  return run[law] && run[law]->unexplained > kRepairGain * laws.most[law];
}

}  // namespace

OddLaws odd_laws(const std::vector<Relations>& relations, std::size_t run) {
  const Relations& own = relations[run];
  OddLaws laws{.most = std::vector<double>(own.size(), kExactRelation)};
  std::set<double> kinds;  // laws of one kind (left and right, or of the motion) have one bound
  for (std::size_t law = 0; law < own.size(); ++law) {
    std::size_t others = 0;
    for (std::size_t r = 0; r < relations.size(); ++r)
      if (r != run && relations[r][law])
        laws.most[law] = std::max(laws.most[law], relations[r][law]->unexplained), ++others;
    if (others + 1 < kLeastRunsToName) laws.most[law] = std::numeric_limits<double>::infinity();
    if (is_odd(laws, own, law)) laws.odd.push_back(law), kinds.insert(own[law]->sound);
  }
  laws.suspect = kinds.size() >= kLeastOddKinds;
  return laws;
}

std::optional<double> repair_gain(const OddLaws& laws, const Relations& logged, const Relations& repaired) {
  for (std::size_t law = 0; law < repaired.size(); ++law)
    if (is_odd(laws, repaired, law)) return {};
  double nats = 0;
  for (const std::size_t law : laws.odd) {
    if (!repaired[law]) return {};
    nats +=
        std::log((logged[law]->unexplained + kExactRelation) / (repaired[law]->unexplained + kExactRelation));
  }
  return nats;
}

}  // namespace joulepath
