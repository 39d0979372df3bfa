#pragma once

#include <functional>
#include <optional>
#include <string>

namespace joulepath::studio {

struct HttpRequest {
  std::string method{};
  std::string target{};
  std::string host{};    ///< empty where the header is absent
  std::string origin{};  ///< likewise
  std::string body{};
};

struct HttpResponse {
  int status{200};
  std::string type{"text/plain"};
  std::string body{};
};

struct HttpService {
  /// Called once, with the port that is served.
  std::function<void(int port)> ready;
  /// Refuses a request by its headers, before its body is read; empty: it is admitted.
  std::function<std::optional<HttpResponse>(const HttpRequest&)> refusal;
  /// Called in a thread of its own for each admitted request.
  std::function<HttpResponse(const HttpRequest&)> answer;
};

/// Serves HTTP/1.1 on the loopback interface until the program ends, with one request for each connection.
/// `port` 0: any that is free. Throws std::system_error where none is. What a request takes is bounded:
/// 16 KiB of headers within 5 s, then 16 MiB of body within 30 s. Connections whose request is not admitted,
/// or not yet, hold no other one up: beyond 100 of them the oldest ends.
[[noreturn]] void serve_http(int port, const HttpService& service);

}  // namespace joulepath::studio
