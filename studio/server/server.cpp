#include "studio/server/server.hpp"

#include <httplib.h>

#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <system_error>

#include "model/stop.hpp"
#include "scenarios/schema.hpp"
#include "studio/answer/grid_json.hpp"
#include "studio/server/page.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

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

  void run(const std::function<void(const std::string&)>& ready) {
    const std::string base = "/" + random_token() + "/";
    server_.set_payload_max_length(kMostBytes);
    server_.set_tcp_nodelay(true);
    server_.set_pre_routing_handler([this](const auto& request, auto& response) {
      return refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                        : httplib::Server::HandlerResponse::Unhandled;
    });
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Frame-Options", "DENY"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"}});
    server_.Get(base, [this](const auto&, auto& response) {
      guarded(response, "text/html; charset=utf-8", [&] {
        return studio::page(page_data(files_, floor_, "", options_.diagnosis), options_.page_folder);
      });
    });
    server_.Get(base + "files", [this](const auto&, auto& response) {
      guarded(response, kJson, [&] { return files_.load().dump(); });
    });
    server_.Post(base + "answer", [this](const auto& request, auto& response) {
      guarded(response, kJson, [&] { return answer(request.body); });
    });
    server_.Post(base + "save", [this](const auto& request, auto& response) {
      guarded(response, kJson,
              [&] { return files_.save(nlohmann::ordered_json::parse(request.body)).dump(); });
    });
    const bool bound = options_.port > 0 ? server_.bind_to_port("127.0.0.1", options_.port)
                                         : (port_ = server_.bind_to_any_port("127.0.0.1")) > 0;
    if (!bound) throw std::system_error(std::make_error_code(std::errc::address_in_use), "port");
    if (options_.port > 0) port_ = options_.port;
    ready("http://127.0.0.1:" + std::to_string(port_) + base);
    server_.listen_after_bind();
  }

 private:
  static constexpr const char* kJson = "application/json";

  /// Rejects requests of another site's page, whatever name it gave to this address.
  bool refused(const httplib::Request& request, httplib::Response& response) const {
    const std::string port = std::to_string(port_), host = request.get_header_value("Host");
    const bool own_host = host == "127.0.0.1:" + port || host == "localhost:" + port;
    const std::string origin = request.get_header_value("Origin");
    const bool own_origin = origin == "http://" + host || (origin.empty() && request.method == "GET");
    if (own_host && own_origin) return false;
    response.status = 403;
    response.set_content("refused: the request comes from another site\n", "text/plain");
    return true;
  }

  template <class Make>
  static void guarded(httplib::Response& response, const char* type, const Make& make) {
    try {
      response.set_content(make(), type);
    } catch (const Superseded&) {
      response.set_content(R"({"superseded": true})", kJson);
    } catch (const std::exception& error) {
      response.status = 400;
      response.set_content(
          json{{"error", {{"message", error.what()}}}}.dump(-1, ' ', true, json::error_handler_t::replace),
          kJson);
    }
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
    const json asked = json::parse(question);
    refuse_other_order(asked);
    const Newest::Key key{asked.value("page", ""), asked.value("mode", "")};
    const long number = newest_.next(key);
    const StopScope stop([&] {
      if (!newest_.is(key, number)) throw Superseded{};
    });
    return session_.answer(question);
  }

  MissionFiles& files_;
  ServerOptions options_;
  MissionWorld floor_;
  Session session_;
  Newest newest_{};
  httplib::Server server_{};
  int port_{};
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
