#include "extensions/onboard/drift_schema.hpp"

namespace joulepath {
namespace {

Schema result_or_null() { return nullable(number()); }  ///< null if it is not finite

}  // namespace

Schema drift_schema() {
  return open(map(
      {required("schema", text()), required("days", list(text()), "oldest first"),
       required("false_alarm_rate", number(kFraction),
                "probability of a false alarm in a night without drift"),
       required("answer", choice({"drift", "no_drift", "cannot_tell"}),
                "cannot_tell: no constant is determined by the first and by the last day"),
       required("drifted", list(text()), "names of constants"),
       required(
           "parameters",
           list(open(map({required("name", text()), required("unit", text()),
                          required("reference", result_or_null(), "on the first day"),
                          required("value", result_or_null(), "mean from the day `since` to the last one"),
                          required("change_percent", result_or_null()),
                          required("standard_error_percent", result_or_null(), "of the change"),
                          required("since", text(), "first day of the most significant change"),
                          required("days", number(), "days that determine the value, without the first day"),
                          required("statistic", result_or_null(), "change over its standard error"),
                          required("threshold", result_or_null(), "of the statistic"),
                          required("detectable_percent", result_or_null(),
                                   "step on the second day that is found with a probability of 80 %"),
                          required("drifted", boolean())})))),
       required("not_compared",
                list(open(map({required("name", text()),
                               required("days", list(text()), "days that do not determine it"),
                               required("why", text()),
                               required("needs", text(), "manoeuvres or channels that show it")}))))}));
}

}  // namespace joulepath
