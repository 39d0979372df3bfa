#include "app/jobs/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "app/command.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

std::optional<JournalRun> run_from(const Json& json) {
  if (!json.is_object() || !json.contains("run") || !json["run"].is_object()) return std::nullopt;
  JournalRun run;
  for (const auto& [key, value] : {std::pair{"command", &run.command},
                                   {"source", &run.source},
                                   {"shard", &run.shard},
                                   {"list", &run.list}}) {
    if (!json["run"].contains(key) || !json["run"][key].is_string()) return std::nullopt;
    *value = json["run"][key];
  }
  return run;
}

bool is_entry(const Json& json) {
  const auto has = [&](const char* key, auto is_right) { return json.contains(key) && is_right(json[key]); };
  return json.is_object() && has("index", [](const Json& v) { return v.is_number_unsigned(); }) &&
         has("fingerprint", [](const Json& v) { return v.is_string(); }) &&
         has("seconds", [](const Json& v) { return v.is_number(); }) &&
         has("result", [](const Json& v) { return v.is_object() && v.contains("status"); }) &&
         json["result"]["status"].is_string();
}

}  // namespace

std::string JournalRun::text() const {
  return "joulepath " + command + " " + source + (shard.empty() ? "" : " --shard " + shard);
}

std::optional<JournalRun> run_of_journal(const std::string& file) {
  std::optional<JournalRun> found;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (const auto run = run_from(shallow_json<Json>(line))) found = run;
  return found;
}

JobJournal::JobJournal(std::string file, Use use) : file_(std::move(file)) {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw EnvironmentError("cannot write " + file_ + ": " + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    throw EnvironmentError("another run is writing " + file_);
  }
  if (use == Use::resume)
    read();
  else if (::ftruncate(descriptor_, 0) != 0)
    throw EnvironmentError("cannot write " + file_ + ": " + std::strerror(errno));
}

JobJournal::~JobJournal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// A kill may have cut off the last line; a line break after it separates it from the next line.
void JobJournal::read() {
  std::ifstream in(file_);
  std::string line;
  bool cut = false;
  while (std::getline(in, line)) {
    cut = in.eof();
    const Json json = shallow_json<Json>(line);
    if (const auto run = run_from(json)) run_ = run;
    if (!is_entry(json)) continue;
    const auto index = json["index"].get<std::size_t>();
    earlier_[index] = {.fingerprint = json["fingerprint"],
                       .result = {.index = index,
                                  .line = json["result"].dump(),
                                  .status = json["result"]["status"],
                                  .seconds = json["seconds"]}};
  }
  if (cut) append("\n");
}

void JobJournal::append(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const auto written = ::write(descriptor_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw EnvironmentError("cannot write " + file_ + ": " + std::strerror(errno));
    done += static_cast<std::size_t>(written);
  }
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL)
    throw EnvironmentError("cannot write " + file_ + ": " + std::strerror(errno));
}

void JobJournal::begin(const JournalRun& run) {
  if (run_ == run) return;
  const Json json{
      {"run", {{"command", run.command}, {"source", run.source}, {"shard", run.shard}, {"list", run.list}}}};
  append(json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  run_ = run;
}

void JobJournal::add(const JobResult& result, const std::string& fingerprint) {
  append(Json{{"index", result.index},
              {"fingerprint", fingerprint},
              {"seconds", result.seconds},
              {"result", Json::parse(result.line)}}
             .dump() +
         "\n");
}

const JobResult* JobJournal::find(std::size_t index, const std::string& fingerprint) const {
  const auto found = earlier_.find(index);
  if (fingerprint.empty() || found == earlier_.end() || found->second.fingerprint != fingerprint)
    return nullptr;
  return &found->second.result;
}

}  // namespace joulepath
