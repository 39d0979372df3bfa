#include "observer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "box_fit.hpp"
#include "rivals.hpp"
// Design: docs/decisions/0802-blind-benchmark.md
namespace blind {
namespace {

constexpr Discretization kCoarse{2e-3, false};  // for the rivals' derivatives
constexpr double kFar = 1000;                   // linear ratios beyond this are not driven again

/// Rivals that stand together against the truth.
struct Candidate {
  std::vector<const Rival*> rivals{};
  Fit fit{};

  std::string name() const {
    std::string text = rivals[0]->effect.name;
    for (std::size_t k = 1; k < rivals.size(); ++k) text += "+" + rivals[k]->effect.name;
    return text;
  }
  Vector bounds(Vector Rival::*which) const {
    Vector all;
    for (const Rival* rival : rivals) all.insert(all.end(), (rival->*which).begin(), (rival->*which).end());
    return all;
  }
  /// Columns of the amplitudes, then each bending rival's bend at the present amplitudes.
  std::vector<Combination> columns(std::size_t bend_offset, std::size_t* bends) const {
    std::vector<Combination> all, bent;
    std::size_t next = 0;
    for (const Rival* rival : rivals) {
      Combination bend;
      for (const std::size_t column : rival->at) {
        all.push_back({{column, 1.0}});
        const double a = next < fit.amplitude.size() ? fit.amplitude[next] : 0.0;
        bend.emplace_back(column + bend_offset, a);
        ++next;
      }
      if (rival->bends && !fit.amplitude.empty()) bent.push_back(bend);
    }
    *bends = bent.size();
    all.insert(all.end(), bent.begin(), bent.end());
    return all;
  }
};

class Observer {
 public:
  Observer(const Case& c, const std::vector<Vector>& full, const std::vector<RunDirections>& directions)
      : c_(c), full_(full), directions_(directions), plain_(scene_with(c, {})), columns_(c.runs.size()) {
    World bent = c.world;
    bent.form += kFormSigma;
    for (std::size_t run = 0; run < c.runs.size(); ++run)
      truth_bend_.push_back(difference(simulate(c, {c.truth, bent}, run), full[run], 1.0));
    drive_rivals();
  }

  Separation separation(double none_ratio) {
    const Matrix gram = linear_gram();
    std::vector<Candidate> singles, pairs;
    for (std::size_t i = 0; i < rivals_.size(); ++i) {
      singles.push_back(fitted(gram, {{&rivals_[i]}, {}}));
      for (std::size_t j = i + 1; j < rivals_.size(); ++j)
        if (rivals_[i].effect.name != rivals_[j].effect.name)
          pairs.push_back(fitted(gram, {{&rivals_[i], &rivals_[j]}, {}}));
    }
    const Candidate single = nearest(singles, 2, none_ratio), pair = nearest(pairs, 3, none_ratio);
    const Candidate& best = pair.fit.value < single.fit.value ? pair : single;
    return {best.fit.value, single.fit.value, best.name()};
  }

 private:
  /// Signatures of all rivals per unit of their amplitudes, and of their bends.
  void drive_rivals() {
    std::vector<Vector> plain;
    for (std::size_t run = 0; run < c_.runs.size(); ++run)
      plain.push_back(simulate(c_, plain_, run, kCoarse));
    std::vector<std::vector<Vector>> bends(c_.runs.size());
    for (Rival& rival : rivals_of(c_, c_.effects[0].name)) {
      for (std::size_t k = 0; k < rival.step.size(); ++k) {
        Vector amplitude(rival.step.size());
        amplitude[k] = rival.step[k];
        Scene scene = plain_;
        put_rival(c_, rival, amplitude, scene);
        Scene bent = scene;
        bent.world.form += kFormSigma;
        rival.at.push_back(columns_[0].size() + 1);
        for (std::size_t run = 0; run < c_.runs.size(); ++run) {
          const Vector with = simulate(c_, scene, run, kCoarse);
          columns_[run].push_back(difference(with, plain[run], 1 / rival.step[k]));
          bends[run].push_back(rival.bends
                                   ? difference(simulate(c_, bent, run, kCoarse), with, 1 / rival.step[k])
                                   : Vector(with.size()));
        }
      }
      rivals_.push_back(rival);
    }
    bend_offset_ = columns_[0].size();
    for (std::size_t run = 0; run < c_.runs.size(); ++run)
      columns_[run].insert(columns_[run].end(), bends[run].begin(), bends[run].end());
  }

  /// Gram matrix of the effect, the rivals and their bends: what is unknown otherwise is marginalized.
  Matrix linear_gram() const {
    Matrix sum;
    for (std::size_t run = 0; run < c_.runs.size(); ++run) {
      std::vector<Vector> all{difference(full_[run], simulate(c_, plain_, run), 1.0)};
      all.insert(all.end(), columns_[run].begin(), columns_[run].end());
      all.push_back(truth_bend_[run]);
      add(sum, all, run);
    }
    return marginalized(sum, kNuisances + 1, 1.0);
  }

  /// Add a run's Gram matrix: these columns and the nuisances, the run's scatter marginalized.
  void add(Matrix& sum, std::vector<Vector>& all, std::size_t run) const {
    const RunDirections& d = directions_[run];
    all.insert(all.end(), d.nuisance.begin(), d.nuisance.end());
    all.insert(all.end(), d.scatter.begin(), d.scatter.end());
    const Matrix gram = marginalized(gram_of(all), d.scatter.size(), 1.0);
    if (sum.empty()) sum = Matrix(gram.size(), Vector(gram.size()));
    for (std::size_t i = 0; i < sum.size(); ++i)
      for (std::size_t j = 0; j < sum.size(); ++j) sum[i][j] += gram[i][j];
  }

  /// The candidate's best amplitudes in the linear account. The bends are those of the amplitudes: repeated.
  Candidate fitted(const Matrix& gram, Candidate candidate) const {
    for (int round = 0; round < 3; ++round) {
      std::size_t bends = 0;
      std::vector<Combination> wanted{{{0, 1.0}}};
      const auto columns = candidate.columns(bend_offset_, &bends);
      wanted.insert(wanted.end(), columns.begin(), columns.end());
      candidate.fit = boxed(marginalized(combined(gram, wanted), bends, 1.0), candidate.bounds(&Rival::least),
                            candidate.bounds(&Rival::most));
    }
    return candidate;
  }

  /// The nearest of the candidates: the first few by the linear account are driven as they are.
  Candidate nearest(std::vector<Candidate>& candidates, std::size_t count, double none_ratio) const {
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.fit.value < b.fit.value; });
    Candidate best = candidates[0];
    if (best.fit.value > kFar) return best;
    best.fit.value = none_ratio;  // amplitudes of zero
    for (std::size_t k = 0; k < std::min(count, candidates.size()); ++k) {
      const double value = driven(candidates[k]);
      if (value >= best.fit.value) continue;
      best = candidates[k];
      best.fit.value = value;
    }
    return best;
  }

  /// The ratio against rivals that are driven at their amplitudes, with the calibration error that helps them
  /// most: Gauss-Newton, because what accumulates in the pose is not linear.
  double driven(const Candidate& start) const {
    Candidate now = start;
    Vector nu(kNuisances, 0.0);
    double value = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 3; ++round) {
      const Step step = stepped(now, nu);
      if (!(step.fit.value < value)) break;
      value = step.fit.value;
      for (std::size_t k = 0; k < nu.size(); ++k) nu[k] += step.nu[k];
      for (std::size_t k = 0; k < now.fit.amplitude.size(); ++k)
        now.fit.amplitude[k] += step.fit.amplitude[k];
    }
    return value;
  }

  struct Step {
    Fit fit{};
    Vector nu{};
  };

  Step stepped(const Candidate& now, const Vector& nu) const {
    Scene scene = plain_;
    std::size_t next = 0, bends = 0;
    for (const Rival* rival : now.rivals) {
      Vector amplitudes;
      for (std::size_t k = 0; k < rival->at.size(); ++k) amplitudes.push_back(now.fit.amplitude[next++]);
      put_rival(c_, *rival, amplitudes, scene);
    }
    scene = shifted(scene, nu);
    const std::vector<Combination> wanted = now.columns(bend_offset_, &bends);
    Matrix sum;
    for (std::size_t run = 0; run < c_.runs.size(); ++run) {
      std::vector<Vector> all{difference(full_[run], simulate(c_, scene, run), 1.0)};
      for (const Combination& one : wanted) {
        Vector column(all[0].size());
        for (const auto& [at, weight] : one)
          for (std::size_t k = 0; k < column.size(); ++k) column[k] += weight * columns_[run][at - 1][k];
        all.push_back(column);
      }
      all.push_back(truth_bend_[run]);
      add(sum, all, run);
    }
    const std::size_t amplitudes = now.fit.amplitude.size(), first = sum.size() - kNuisances;
    for (std::size_t k = 0; k < kNuisances; ++k) {  // the prior's pull, about nu
      sum[0][0] += nu[k] * nu[k];
      sum[0][first + k] -= nu[k];
      sum[first + k][0] -= nu[k];
    }
    Vector least = now.bounds(&Rival::least), most = now.bounds(&Rival::most);
    for (std::size_t k = 0; k < amplitudes; ++k) {
      least[k] -= now.fit.amplitude[k];
      most[k] -= now.fit.amplitude[k];
    }
    Step step;
    step.fit = boxed(marginalized(sum, kNuisances + 1 + bends, 1.0), least, most);
    if (!step.fit.amplitude.empty()) step.nu = nuisance_step(sum, step.fit.amplitude);
    return step;
  }

  /// All unknowns of unit prior at these amplitudes; those of the calibration come last.
  static Vector nuisance_step(const Matrix& sum, const Vector& amplitude) {
    const std::size_t first = amplitude.size() + 1, count = sum.size() - first;
    Matrix system(count, Vector(count));
    Vector right(count);
    for (std::size_t i = 0; i < count; ++i) {
      right[i] = sum[first + i][0];
      for (std::size_t k = 0; k < amplitude.size(); ++k) right[i] -= sum[first + i][k + 1] * amplitude[k];
      for (std::size_t j = 0; j < count; ++j) system[i][j] = sum[first + i][first + j] + (i == j ? 1.0 : 0.0);
    }
    const Vector all = solved(system, right);
    return {all.end() - kNuisances, all.end()};
  }

  const Case& c_;
  const std::vector<Vector>& full_;
  const std::vector<RunDirections>& directions_;
  Scene plain_;
  std::vector<std::vector<Vector>> columns_;  ///< of each run: amplitudes of all rivals, then their bends
  std::vector<Vector> truth_bend_{};
  std::vector<Rival> rivals_{};
  std::size_t bend_offset_{};
};

}  // namespace

Separation separation_of(const Case& c, const std::vector<Vector>& full,
                         const std::vector<RunDirections>& directions, double none_ratio) {
  return Observer(c, full, directions).separation(none_ratio);
}

}  // namespace blind
