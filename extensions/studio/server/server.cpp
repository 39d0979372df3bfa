#include "extensions/studio/server/server.hpp"

#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>

#include "extensions/studio/answer/asked.hpp"
#include "extensions/studio/answer/grid_json.hpp"
#include "extensions/studio/server/http.hpp"
#include "extensions/studio/server/page.hpp"
#include "model/stop.hpp"
#include "scenarios/file_kinds.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;
std::string random_token() {
  std::random_device random;
  std::string token;
  for (int k = 0; k < 32; ++k) token += "0123456789abcdef"[random() % 16];
  return token;
}

json schema_of(const std::string& kind) {
  for (const FileKind& file : file_kinds())
    if (file.name == kind) return json::parse(json_schema(file));
  return nullptr;
}

/// Thrown by a question that a newer one of the same page replaces.
struct Superseded {};

/// The newest question of each page in each mode; older ones end early.
class Newest {
 public:
  using Key = std::pair<std::string, std::string>;
  long next(const Key& key) {
    const std::scoped_lock guard(lock_);
    if (newest_.size() > 1000) newest_.clear();
    return newest_[key] = ++count_;
  }
  bool is(const Key& key, long number) {
    const std::scoped_lock guard(lock_);
    const auto found = newest_.find(key);
    return found == newest_.end() || found->second == number;
  }

 private:
  std::mutex lock_{};
  long count_{};
  std::map<Key, long> newest_{};
};

class Studio {
 public:
  Studio(MissionFiles& files, const ServerOptions& options)
      : files_(files), options_(options), floor_(files.read_floor()), session_(floor_, files.folder()) {}

  [[noreturn]] void run(const std::function<void(const std::string&)>& ready) {
    serve_http(options_.port, {.ready =
                                   [&](int port) {
                                     port_ = std::to_string(port);
                                     ready("http://127.0.0.1:" + port_ + base_);
                                   },
                               .refusal = [this](const HttpRequest& request) { return refusal(request); },
                               .answer = [this](const HttpRequest& request) { return guarded(request); }});
  }

 private:
  static constexpr const char* kJson = "application/json";

  /// Refuses requests of another site's page, whatever name it gave to this address, and those without the
  /// token.
  [[nodiscard]] std::optional<HttpResponse> refusal(const HttpRequest& request) const {
    const bool own_host = request.host == "127.0.0.1:" + port_ || request.host == "localhost:" + port_;
    const bool own_origin =
        request.origin == "http://" + request.host || (request.origin.empty() && request.method == "GET");
    if (!own_host || !own_origin)
      return HttpResponse{.status = 403, .body = "refused: the request comes from another site\n"};
    if (is_known(request)) return std::nullopt;
    return HttpResponse{.status = 404, .body = "nothing is here\n"};
  }

  [[nodiscard]] bool is_known(const HttpRequest& request) const {
    const std::string& target = request.target;
    if (request.method == "GET") return target == base_ || target == base_ + "files";
    return request.method == "POST" && (target == base_ + "answer" || target == base_ + "save");
  }

  HttpResponse guarded(const HttpRequest& request) {
    try {
      return response_to(request);
    } catch (const Superseded&) {
      return {.type = kJson, .body = R"({"superseded": true})"};
    } catch (const std::exception& error) {
      return {.status = 400,
              .type = kJson,
              .body = json{{"error", {{"message", error.what()}}}}.dump(-1, ' ', true,
                                                                        json::error_handler_t::replace)};
    }
  }

  /// Of a request that refusal() admits.
  HttpResponse response_to(const HttpRequest& request) {
    const std::string what = request.target.substr(base_.size());
    if (what.empty())
      return {.type = "text/html; charset=utf-8",
              .body = studio::page(page_data(files_, floor_, "", options_.diagnosis), options_.page_folder)};
    if (what == "files") return {.type = kJson, .body = files_.load().dump()};
    if (what == "answer") return {.type = kJson, .body = answer(request.body)};
    return {.type = kJson, .body = files_.save(question_from<nlohmann::ordered_json>(request.body)).dump()};
  }

  /// An order is the one file that planning reads: which one is the mission file's to say, not the page's.
  void refuse_other_order(const json& question) const {
    const json mission = question.value("mission", json::object());
    if (!mission.contains("order") || mission["order"] == json(files_.load()["mission"].value("order", "")))
      return;
    throw ConfigError(
        {{}, "order", "another file than the mission's own", "the one that the file names", ""});
  }

  std::string answer(const std::string& question) {
    const json asked = question_from<json>(question);
    refuse_other_order(asked);
    const Newest::Key key{asked.value("page", ""), asked.value("mode", "")};
    const long number = newest_.next(key);
    const StopScope stop([&] {
      if (!newest_.is(key, number)) throw Superseded{};
    });
    return key.second == "plan" ? searched(asked, question) : session_.answer(question);
  }

  /// One search at a time; pages that ask the same one after the other share its answer.
  std::string searched(json asked, const std::string& question) {
    asked.erase("page");
    std::unique_lock guard(search_, std::defer_lock);
    do stop_if_asked();
    while (!guard.try_lock_for(std::chrono::milliseconds(50)));
    const bool reads_files = asked.contains("mission") && asked["mission"].contains("order");
    if (std::string content = asked.dump(); reads_files || content != searched_) {
      found_ = session_.answer(question);
      searched_ = std::move(content);
      ++searches_;
    }
    return "{\"search\":" + std::to_string(searches_) + "," + found_.substr(1);
  }

  MissionFiles& files_;
  ServerOptions options_;
  MissionWorld floor_;
  Session session_;
  Newest newest_{};
  std::timed_mutex search_{};
  long searches_{};
  std::string searched_{}, found_{};  ///< the last question that searches ways, and its answer
  std::string port_{};
  const std::string base_ = "/" + random_token() + "/";
};

}  // namespace

json page_data(const MissionFiles& files, const MissionWorld& floor, const std::string& answer,
               const std::string& diagnosis) {
  json data{{"files", files.load().dump()},
            {"floor", floor_json(floor)},
            {"schemas", {{"mission", schema_of("mission")}, {"robot", schema_of("robot")}}},
            {"served", answer.empty()}};
  if (!answer.empty()) data["answer"] = json::parse(answer);
  if (!diagnosis.empty()) data["diagnosis"] = json::parse(diagnosis);
  return data;
}

void serve(MissionFiles& files, const ServerOptions& options,
           const std::function<void(const std::string&)>& ready) {
  Studio(files, options).run(ready);
}

}  // namespace joulepath::studio
