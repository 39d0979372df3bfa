#include "extensions/studies/result_schemas.hpp"

namespace joulepath {

Schema sweep_schema() {
  const Schema design = open(map({required("parameters", dictionary(any_of({number(), text()})))}));
  const Schema effects = open(map({required("main", list(open(map({required("parameter", text())})))),
                                   required("interactions", list(open(map({})))),
                                   required("unexplained", nullable(number()), "share of the variance")}));
  return open(map(
      {required("schema", text()), required("designs", integer(kNotNegative)),
       required("rows", integer(kNotNegative)),
       required("planned", integer(kNotNegative), "designs with a plan for every mission"),
       required("within_constraints", integer(kNotNegative)),
       required("held_constant", list(text()), "quantities that are constant in the comparison of designs"),
       optional("best", design), optional("optimized", design), required("pareto", list(design)),
       required("effects", dictionary(effects), "by result: share of the variance of each parameter")}));
}

Schema shard_schema() {
  return open(map({required("schema", text()), required("command", choice({"batch", "sweep"})),
                   required("version", text()),
                   required("build", text(), "digest of the program's sources and compiler"),
                   required("shard", integer({1, 1e6})), required("of", integer({1, 1e6})),
                   required("jobs", integer({1, 1e8}), "of all shards"), required("title", text()),
                   required("options", dictionary(text()), "that change results, by their names"),
                   required("list", text(), "digest of the missions or designs"),
                   required("files", dictionary(text()), "digest of each file that was read"),
                   required("results", text(), "digest of results.jsonl"), optional("study_file", text()),
                   optional("study_text", list(text()), "its lines")}));
}

}  // namespace joulepath
