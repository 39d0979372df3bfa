#include "studio/server/http.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <system_error>
#include <thread>

namespace joulepath::studio {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::seconds;

constexpr std::size_t kMostHeadBytes = 16u << 10, kMostBodyBytes = std::size_t{16} << 20;
constexpr std::size_t kMostWaiting = 100, kMostUnreadBytes = 64u << 20;
constexpr Seconds kHeadTime{5}, kBodyTime{30}, kSendTime{30}, kUnreadTime{2};

/// Ends a request with a status.
struct Refused {
  int status{};
  const char* reason{};
};

const char* reason_of_status(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 408:
      return "Request Timeout";
    case 411:
      return "Length Required";
    case 413:
      return "Content Too Large";
    case 431:
      return "Request Header Fields Too Large";
    default:
      return "Bad Request";
  }
}

/// Waits until a connection can be read (POLLIN) or written (POLLOUT); false after `end`.
bool is_ready(int connection, short events, Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd one{connection, events, 0};
    const int count = ::poll(&one, 1, static_cast<int>(left));
    if (count > 0) return true;
    if (count == 0 || errno != EINTR) return false;
  }
}

/// Bytes as they come, at most `most` of them; none: the connection ended. Throws Refused after `end`.
std::string received(int connection, std::size_t most, Clock::time_point end) {
  if (!is_ready(connection, POLLIN, end)) throw Refused{408, "the request took too long"};
  std::string bytes(std::min<std::size_t>(most, 64u << 10), '\0');
  const auto count = ::recv(connection, bytes.data(), bytes.size(), 0);
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

void send_all(int connection, const std::string& bytes) {
  const auto end = Clock::now() + kSendTime;
  for (std::size_t sent = 0; sent < bytes.size() && is_ready(connection, POLLOUT, end);) {
    const auto count =
        ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && errno != EINTR && errno != EAGAIN) return;
    sent += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
}

/// Ends a connection after its answer. What it still sends is dropped: unread bytes would reset the
/// connection before the other side has read the answer.
void hang_up(int connection) try {
  ::shutdown(connection, SHUT_WR);
  const auto end = Clock::now() + kUnreadTime;
  for (std::size_t dropped = 0; dropped < kMostUnreadBytes;) {
    const std::size_t count = received(connection, 64u << 10, end).size();
    if (count == 0) return;
    dropped += count;
  }
} catch (const Refused&) {
}

/// The first bytes of a connection, up to the end of its headers or a little beyond.
std::string received_head(int connection) {
  const auto end = Clock::now() + kHeadTime;
  std::string bytes;
  while (bytes.find("\r\n\r\n") == std::string::npos) {
    if (bytes.size() >= kMostHeadBytes) throw Refused{431, "the headers are too long"};
    const std::string more = received(connection, kMostHeadBytes - bytes.size(), end);
    if (more.empty()) throw Refused{400, "the request ends early"};
    bytes += more;
  }
  return bytes;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t");
  return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(" \t") - from + 1);
}

/// `head`: the request's lines, without the empty one at their end.
HttpRequest parsed_request(const std::string& head) {
  const std::size_t line_end = std::min(head.find("\r\n"), head.size());
  const std::string line = head.substr(0, line_end);
  const std::size_t method_end = line.find(' '), target_end = line.rfind(' ');
  if (method_end == std::string::npos || target_end == method_end ||
      line.compare(target_end, 8, " HTTP/1.") != 0)
    throw Refused{400, "no request of HTTP/1.1"};
  HttpRequest request{.method = line.substr(0, method_end),
                      .target = line.substr(method_end + 1, target_end - method_end - 1)};
  for (std::size_t at = line_end; at < head.size();) {
    at += 2;
    const std::size_t end = std::min(head.find("\r\n", at), head.size());
    const std::string field = head.substr(at, end - at);
    const std::size_t colon = field.find(':');
    if (colon == 0 || colon == std::string::npos || field.find_first_of(" \t") < colon)
      throw Refused{400, "a header that is none"};
    if (!request.headers.try_emplace(lower(field.substr(0, colon)), trimmed(field.substr(colon + 1))).second)
      throw Refused{400, "a header twice"};
    at = end;
  }
  return request;
}

std::size_t body_size(const HttpRequest& request) {
  if (request.headers.contains("transfer-encoding")) throw Refused{411, "a body without an announced size"};
  if (!request.headers.contains("content-length")) return 0;
  const std::string text = request.header("content-length");
  std::size_t size{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  if (text.empty() || end != text.data() + text.size() || error == std::errc::invalid_argument)
    throw Refused{400, "a size that is no number"};
  if (error != std::errc{} || size > kMostBodyBytes) throw Refused{413, "more than 16 MiB"};
  return size;
}

/// `begun`: the bytes of it that came with the headers.
std::string received_body(int connection, std::string begun, std::size_t size) {
  const auto end = Clock::now() + kBodyTime;
  begun.resize(std::min(begun.size(), size));
  while (begun.size() < size) {
    const std::string more = received(connection, size - begun.size(), end);
    if (more.empty()) throw Refused{400, "the body ends early"};
    begun += more;
  }
  return begun;
}

std::string text_of_response(const HttpResponse& response) {
  return "HTTP/1.1 " + std::to_string(response.status) + " " + reason_of_status(response.status) +
         "\r\nContent-Type: " + response.type +
         "\r\nContent-Length: " + std::to_string(response.body.size()) +
         "\r\nConnection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff"
         "\r\nReferrer-Policy: no-referrer\r\nX-Frame-Options: DENY"
         "\r\nCross-Origin-Resource-Policy: same-origin\r\n\r\n" +
         response.body;
}

[[noreturn]] void fail_socket(const char* doing) {
  throw std::system_error(errno, std::generic_category(), doing);
}

}  // namespace

std::string HttpRequest::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? "" : found->second;
}

HttpServer::HttpServer(int port) : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (listener_ < 0) fail_socket("port");
  const int on = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, any, size) != 0 || ::listen(listener_, SOMAXCONN) != 0 ||
      ::getsockname(listener_, any, &size) != 0) {
    const int reason = errno;
    ::close(listener_);
    errno = reason;
    fail_socket("port");
  }
  port_ = ntohs(address.sin_port);
}

void HttpServer::run(Admit admit, Answer answer) {
  admit_ = std::move(admit);
  answer_ = std::move(answer);
  for (;;) {
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) {  // no descriptor is free, or the other side left
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    const auto waiting = await(connection);
    try {
      std::thread(&HttpServer::serve, this, connection, waiting).detach();
    } catch (const std::system_error&) {  // no thread is free
      const std::scoped_lock guard(lock_);
      waiting_.erase(waiting);
      ::close(connection);
    }
  }
}

std::list<int>::iterator HttpServer::await(int connection) {
  const std::scoped_lock guard(lock_);
  if (waiting_.size() >= kMostWaiting)  // wakes its thread, which closes it
    for (auto oldest = waiting_.begin();
         std::distance(oldest, waiting_.end()) >= static_cast<long>(kMostWaiting); ++oldest)
      ::shutdown(*oldest, SHUT_RDWR);
  return waiting_.insert(waiting_.end(), connection);
}

HttpResponse HttpServer::response_to(int connection, std::list<int>::iterator waiting) {
  std::string head;
  std::optional<Refused> refused;
  try {
    head = received_head(connection);
  } catch (const Refused& reason) {
    refused = reason;
  }
  {
    const std::scoped_lock guard(lock_);
    waiting_.erase(waiting);
  }
  if (refused) throw *refused;
  const std::size_t end = head.find("\r\n\r\n");
  HttpRequest request = parsed_request(head.substr(0, end));
  if (auto response = admit_(request)) return *std::move(response);
  request.body = received_body(connection, head.substr(end + 4), body_size(request));
  return answer_(request);
}

void HttpServer::serve(int connection, std::list<int>::iterator waiting) {
  try {
    send_all(connection, text_of_response(response_to(connection, waiting)));
  } catch (const Refused& refused) {
    send_all(connection,
             text_of_response({.status = refused.status, .body = std::string(refused.reason) + "\n"}));
  } catch (const std::exception&) {  // out of memory, for one: the others are served on
    send_all(connection, text_of_response({.status = 400, .body = "the request was not answered\n"}));
  }
  hang_up(connection);
  ::close(connection);
}

}  // namespace joulepath::studio
