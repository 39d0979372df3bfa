#include "extensions/onboard/monitor/e_detector.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {

EDetector::EDetector(double tolerance, std::vector<double> sizes, double hours_per_false_alarm)
    : tolerance_(tolerance), limit_h_(hours_per_false_alarm) {
  for (const double size : sizes)
    for (const double sign : {1.0, -1.0}) alternatives_.push_back({.shift = size, .sign = sign});
}

bool EDetector::add(double value, double sigma, double hours, double begin_s) {
  constexpr double kMostEvidence = 1e250;  // a double's range
  if (!(sigma > 0) || !std::isfinite(value) || !std::isfinite(sigma)) return false;
  for (Alternative& a : alternatives_) {
    const double beyond = a.sign * (value - reference_) - tolerance_;
    const double log_ratio = a.shift * (beyond - 0.5 * a.shift) / (sigma * sigma);
    a.evidence_h = std::min((a.evidence_h + hours) * std::exp(std::min(log_ratio, 500.0)), kMostEvidence);
    if (a.cusum <= 0) a.since_s = begin_s;
    a.cusum = std::max(0.0, a.cusum + log_ratio);
  }
  return evidence_hours() >= limit_h_;
}

void EDetector::restart(double reference) {
  reference_ = reference;
  for (Alternative& a : alternatives_) a.evidence_h = a.cusum = 0;
}

double EDetector::evidence_hours() const {
  double sum_h = 0;
  for (const Alternative& a : alternatives_) sum_h += a.evidence_h;
  return sum_h / static_cast<double>(alternatives_.size());
}

const EDetector::Alternative& EDetector::largest() const {
  return *std::max_element(
      alternatives_.begin(), alternatives_.end(),
      [](const Alternative& a, const Alternative& b) { return a.evidence_h < b.evidence_h; });
}

double EDetector::since_s() const { return largest().since_s; }

bool EDetector::suspicious() const {
  return std::any_of(alternatives_.begin(), alternatives_.end(),
                     [](const Alternative& a) { return a.cusum > 0; });
}

}  // namespace joulepath
