#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace joulepath::studio {

struct HttpRequest {
  std::string method{};
  std::string target{};
  std::map<std::string, std::string> headers{};  ///< names in lower case
  std::string body{};

  [[nodiscard]] std::string header(const std::string& name) const;  ///< empty where it is absent
};

struct HttpResponse {
  int status{200};
  std::string type{"text/plain"};
  std::string body{};
};

/// HTTP/1.1 (RFC 9112) on the loopback interface, with one request for each connection. What a request takes
/// is bounded: 16 KiB of headers within 5 s, then a body of an announced size up to 16 MiB within 30 s; there
/// are no chunked bodies. A connection that is slow to send its headers holds no other one up: beyond 100 of
/// them the oldest ends.
class HttpServer {
 public:
  /// Refuses a request by its headers, before its body is read; empty: it is admitted.
  using Admit = std::function<std::optional<HttpResponse>(const HttpRequest&)>;
  using Answer = std::function<HttpResponse(const HttpRequest&)>;

  /// `port` 0: any that is free. Throws std::system_error where none is.
  explicit HttpServer(int port);

  [[nodiscard]] int port() const { return port_; }
  /// Answers requests until the program ends, each in a thread of its own.
  [[noreturn]] void run(Admit admit, Answer answer);

 private:
  void serve(int connection, std::list<int>::iterator waiting);
  [[nodiscard]] HttpResponse response_to(int connection, std::list<int>::iterator waiting);
  std::list<int>::iterator await(int connection);

  int listener_{};
  int port_{};
  Admit admit_{};
  Answer answer_{};
  std::mutex lock_{};
  std::list<int> waiting_{};  ///< connections without all of their headers, the oldest first
};

}  // namespace joulepath::studio
