#include "extensions/studio/server/http.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <system_error>
#include <thread>

namespace joulepath::studio {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using net::ip::tcp;
using std::chrono::seconds;

constexpr std::size_t kMostHeadBytes = 16u << 10, kMostBodyBytes = 16u << 20;
constexpr std::size_t kMostUnreadBytes = 64u << 20, kMostWaiting = 100;
constexpr seconds kHeadTime{5}, kBodyTime{30}, kSendTime{30}, kUnreadTime{2};

HttpResponse response_to_error(error_code error) {
  if (error == net::error::not_found) return {.status = 431, .body = "the headers are too long\n"};
  if (error == http::error::body_limit) return {.status = 413, .body = "more than 16 MiB\n"};
  return {.status = 400, .body = "no request of HTTP/1.1: " + error.message() + "\n"};
}

/// One connection with one request. Its handlers run in the thread of the server; they keep it alive.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
  template <class Member>
  auto then(Member member) {
    return beast::bind_front_handler(member, shared_from_this());
  }

 public:
  using Waiting = std::list<HttpSession*>;  ///< sessions without an admitted request, the oldest first

  HttpSession(tcp::socket socket, const HttpService& service, Waiting& waiting)
      : stream_(std::move(socket)), service_(service), waiting_(waiting) {
    parser_.header_limit(kMostHeadBytes);
    parser_.body_limit(kMostBodyBytes);
    if (waiting_.size() >= kMostWaiting) waiting_.front()->end();
    waiting_.push_back(this);
  }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;
  ~HttpSession() { waiting_.remove(this); }

  /// Not async_read_header: in Boost 1.74 header_limit bounds what is not parsed yet. A client whose pieces
  /// each end one byte into a line sends headers without end.
  void read_head() {
    stream_.expires_after(kHeadTime);
    net::async_read_until(stream_, net::dynamic_buffer(head_, kMostHeadBytes), "\r\n\r\n",
                          then(&HttpSession::read_body));
  }

 private:
  void end() {
    waiting_.remove(this);
    stream_.close();
  }

  void read_body(error_code error, std::size_t head_bytes) {
    if (!error) parser_.put(net::buffer(head_, head_bytes), error);
    if (error && error != http::error::body_limit) return send(response_to_error(error));
    const auto& head = parser_.get();
    if (head.count(http::field::host) > 1 || head.count(http::field::origin) > 1)
      return send({.status = 400, .body = "a header twice\n"});
    request_ = {.method = std::string(head.method_string()),
                .target = std::string(head.target()),
                .host = std::string(head[http::field::host]),
                .origin = std::string(head[http::field::origin])};
    if (auto refusal = service_.refusal(request_)) return send(*std::move(refusal));
    waiting_.remove(this);
    if (error) return send(response_to_error(error));
    const auto begun = net::buffer(head_) + head_bytes;
    buffer_.commit(net::buffer_copy(buffer_.prepare(begun.size()), begun));
    stream_.expires_after(kBodyTime);
    http::async_read(stream_, buffer_, parser_, then(&HttpSession::answer));
  }

  void answer(error_code error, std::size_t) {
    if (error) return send(response_to_error(error));
    request_.body = std::move(parser_.get().body());
    std::thread([self = shared_from_this()]() mutable {
      HttpResponse response{.status = 500, .body = "the request was not answered\n"};
      try {
        response = self->service_.answer(self->request_);
      } catch (const std::exception&) {  // out of memory, for one: the others are served on
      }
      const auto executor = self->stream_.get_executor();  // whose thread alone ends the session
      net::post(executor, [self = std::move(self), response = std::move(response)]() mutable {
        self->send(std::move(response));
      });
    }).detach();
  }

  void send(HttpResponse response) {
    response_ = decltype(response_)(http::int_to_status(static_cast<unsigned>(response.status)), 11,
                                    std::move(response.body));
    response_.keep_alive(false);
    response_.prepare_payload();
    response_.set(http::field::content_type, response.type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set(http::field::x_frame_options, "DENY");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    stream_.expires_after(kSendTime);
    http::async_write(stream_, response_, then(&HttpSession::hang_up));
  }

  void hang_up(error_code error, std::size_t) {
    stream_.socket().shutdown(tcp::socket::shutdown_send, error);
    stream_.expires_after(kUnreadTime);
    drop_unread({}, 0);
  }

  /// Unread bytes would reset the connection before the other side has read the answer.
  void drop_unread(error_code error, std::size_t bytes) {
    unread_bytes_ += bytes;
    buffer_.clear();
    if (!error && unread_bytes_ < kMostUnreadBytes)
      stream_.async_read_some(buffer_.prepare(kMostHeadBytes), then(&HttpSession::drop_unread));
  }

  beast::tcp_stream stream_;
  const HttpService& service_;
  Waiting& waiting_;
  std::string head_{};                         ///< and what came with it
  beast::flat_buffer buffer_{kMostHeadBytes};  ///< of the body; it bounds chunk headers and trailers as well
  http::request_parser<http::string_body> parser_{};
  HttpRequest request_{};
  http::response<http::string_body> response_{};
  std::size_t unread_bytes_{};
};

class HttpListener {
 public:
  HttpListener(int port, const HttpService& service)
      : acceptor_(events_, {net::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)}),
        service_(service) {}

  [[noreturn]] void run() {
    service_.ready(acceptor_.local_endpoint().port());
    accept();
    for (;;) try {
        events_.run();
      } catch (const std::exception&) {  // out of memory or threads: a connection ends, others are served on
      }
  }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      accept();
      if (!error) return std::make_shared<HttpSession>(std::move(socket), service_, waiting_)->read_head();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // no descriptor is free
    });
  }

  HttpSession::Waiting waiting_{};
  net::io_context events_{1};
  tcp::acceptor acceptor_;
  const HttpService& service_;
};

}  // namespace

void serve_http(int port, const HttpService& service) try {
  HttpListener(port, service).run();
} catch (const boost::system::system_error& error) {
  throw std::system_error(error.code(), "port");
}

}  // namespace joulepath::studio
