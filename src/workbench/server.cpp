// The only file that knows Boost.Beast.
#include "ostraka/workbench/server.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/words.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <random>
#include <set>
#include <thread>

namespace ostraka {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using boost::system::error_code;

namespace {

std::string random_token() {
    std::random_device device;
    std::string token;
    for (int i = 0; i < 8; ++i) {
        char part[9];
        std::snprintf(part, sizeof part, "%08x", static_cast<unsigned>(device()));
        token += part;
    }
    return token;
}

/// As long as the texts are, whatever they hold.
bool same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing |= static_cast<unsigned>(a[i] ^ b[i]);
    return differing == 0;
}

std::string_view view_of(boost::string_view text) { return {text.data(), text.size()}; }

/// The value of NAME in "a=b&NAME=value" or "a=b; NAME=value".
std::string_view value_in(std::string_view text, std::string_view name, char separator) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(separator), text.size());
        std::string_view part = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
        if (part.size() > name.size() && part.starts_with(name) && part[name.size()] == '=') return part.substr(name.size() + 1);
    }
    return {};
}

using Message = std::shared_ptr<const std::string>;
struct Outgoing {
    Message bytes;
    bool is_text = true;
};

/// [bytes of the JSON, 4][JSON, filled up with blanks to a multiple of eight less four][bytes]
Message packed(const Workbench::Reply& reply) {
    std::string json = reply.json;
    while ((json.size() + 4) % 8 != 0) json += ' ';
    const auto size = static_cast<std::uint32_t>(json.size());
    auto message = std::make_shared<std::string>();
    message->reserve(4 + json.size() + reply.bytes.size());
    for (unsigned k = 0; k < 4; ++k) *message += static_cast<char>(size >> 8 * k & 255);
    *message += json;
    *message += reply.bytes;
    return message;
}

}  // namespace

class Peer;

struct WorkbenchServer::State : std::enable_shared_from_this<WorkbenchServer::State> {
    State(Workbench& w, const ServerLimits& l) : workbench(w), limits(l), acceptor(io), token(random_token()) {}

    Workbench& workbench;
    ServerLimits limits;
    asio::io_context io{1};
    tcp::acceptor acceptor;
    std::string token;
    std::uint16_t port = 0;
    std::atomic<std::size_t> connections{0};
    std::set<std::shared_ptr<Peer>> peers;  ///< of the network's thread

    std::mutex mutex;
    std::condition_variable wakes;
    struct Request {
        std::weak_ptr<Peer> from;
        std::string text;
    };
    std::deque<Request> requests;
    bool ends = false;

    void accept();
    void work();
    void tell_all(const std::string& text, const Peer* but = nullptr);
    [[nodiscard]] bool is_own_host(std::string_view host) const {
        const std::string number = ":" + std::to_string(port);
        return host == "127.0.0.1" + number || host == "localhost" + number;
    }
    [[nodiscard]] bool is_own_origin(std::string_view origin) const {
        return origin.starts_with("http://") && is_own_host(origin.substr(7));
    }
    [[nodiscard]] std::string cookie() const { return "ostraka-" + std::to_string(port); }
};

/// A page that talks.
class Peer : public std::enable_shared_from_this<Peer> {
public:
    Peer(tcp::socket&& socket, std::shared_ptr<WorkbenchServer::State> state)
        : stream_(std::move(socket)), state_(std::move(state)) {
        ++state_->connections;
    }
    ~Peer() { --state_->connections; }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    void begin(const http::request<http::empty_body>& head) {
        websocket::stream_base::timeout timeout{};
        timeout.handshake_timeout = std::chrono::milliseconds(static_cast<long>(1000 * state_->limits.seconds));
        timeout.idle_timeout = std::chrono::seconds(60);  // an open page answers pings; what is gone is let go
        timeout.keep_alive_pings = true;
        stream_.set_option(timeout);
        stream_.read_message_max(state_->limits.message);
        stream_.auto_fragment(false);
        error_code ignored;
        beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
        stream_.async_accept(head, [self = shared_from_this()](error_code error) {
            if (error) return;
            self->state_->peers.insert(self);
            self->read();
        });
    }

    void send(Outgoing message) {
        outgoing_.push_back(std::move(message));
        if (outgoing_.size() == 1) write();
    }
    void answered() { --waiting_; }
    void close() {
        stream_.async_close(websocket::close_code::going_away, [self = shared_from_this()](error_code) {});
    }

private:
    void read() {
        stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) { self->took(error); });
    }
    void took(error_code error) {
        if (error) {
            state_->peers.erase(shared_from_this());
            return;
        }
        std::string text = beast::buffers_to_string(buffer_.data());
        buffer_.consume(buffer_.size());
        if (!stream_.got_text()) return refuse("messages are text");
        if (text == R"({"do":"cancel"})") {
            state_->workbench.cancel();
            return read();
        }
        if (++waiting_ > state_->limits.waiting) return refuse("too many requests at once");
        {
            const std::lock_guard lock(state_->mutex);
            state_->requests.push_back({weak_from_this(), std::move(text)});
        }
        state_->wakes.notify_one();
        read();
    }
    void refuse(const char* why) {
        state_->peers.erase(shared_from_this());
        stream_.async_close({websocket::close_code::policy_error, why}, [self = shared_from_this()](error_code) {});
    }
    void write() {
        stream_.text(outgoing_.front().is_text);
        stream_.async_write(asio::buffer(*outgoing_.front().bytes), [self = shared_from_this()](error_code error, std::size_t) {
            if (error) return;
            self->outgoing_.pop_front();
            if (!self->outgoing_.empty()) self->write();
        });
    }

    websocket::stream<beast::tcp_stream> stream_;
    std::shared_ptr<WorkbenchServer::State> state_;
    beast::flat_buffer buffer_;
    std::deque<Outgoing> outgoing_;
    std::size_t waiting_ = 0;
};

namespace {

/// One request for the page, or for the way of messages.
class Visit : public std::enable_shared_from_this<Visit> {
public:
    Visit(tcp::socket&& socket, std::shared_ptr<WorkbenchServer::State> state)
        : stream_(std::move(socket)), state_(std::move(state)) {
        ++state_->connections;
        parser_.header_limit(static_cast<std::uint32_t>(state_->limits.header));
        parser_.body_limit(0);
    }
    ~Visit() { --state_->connections; }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

    void begin(bool full) {
        stream_.expires_after(std::chrono::milliseconds(static_cast<long>(1000 * state_->limits.seconds)));
        if (full) return answer(http::status::service_unavailable, "too many connections\n");
        http::async_read_header(stream_, buffer_, parser_,
                                [self = shared_from_this()](error_code error, std::size_t) { self->took(error); });
    }

private:
    void took(error_code error) {
        if (error == http::error::header_limit) return answer(http::status::request_header_fields_too_large, "too long a head\n");
        if (error == http::error::body_limit) return answer(http::status::method_not_allowed, "only GET\n");
        if (error == http::error::end_of_stream || error == beast::error::timeout) return;
        if (error) return answer(http::status::bad_request, "not understood\n");
        const auto& head = parser_.get();
        const std::string_view target = view_of(head.target()), host = view_of(head[http::field::host]);
        if (!state_->is_own_host(host)) return answer(http::status::misdirected_request, "this is another host\n");
        if (head.method() != http::verb::get) return answer(http::status::method_not_allowed, "only GET\n");
        const auto origin = head.find(http::field::origin);
        if (origin != head.end() && !state_->is_own_origin(view_of(origin->value())))
            return answer(http::status::forbidden, "asked by another page\n");
        const std::size_t mark = target.find('?');
        const std::string_view path = target.substr(0, mark),
                               query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
        if (path.find("..") != std::string_view::npos || path.find('%') != std::string_view::npos ||
            path.find('\\') != std::string_view::npos)
            return answer(http::status::bad_request, "not understood\n");
        if (path != "/" && path != "/messages") return answer(http::status::not_found, "there is nothing here\n");
        const bool knows = same_secret(value_in(query, "token", '&'), state_->token) ||
                           same_secret(value_in(view_of(head[http::field::cookie]), state_->cookie(), ';'), state_->token);
        if (!knows) return answer(http::status::forbidden, "open the address that 'ostraka workbench' shows: it holds a token\n");
        if (path == "/") return answer(http::status::ok, std::string(workbench_page()), true);
        if (!websocket::is_upgrade(head)) return answer(http::status::upgrade_required, "for messages only\n");
        if (origin == head.end()) return answer(http::status::forbidden, "asked by no page\n");
        http::request<http::empty_body> upgrade;
        upgrade.base() = head.base();
        stream_.expires_never();
        std::make_shared<Peer>(stream_.release_socket(), state_)->begin(upgrade);
    }

    void answer(http::status status, std::string text, bool is_page = false) {
        response_.result(status);
        response_.version(11);
        response_.set(http::field::content_type, is_page ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
        response_.set(http::field::cache_control, "no-store");
        response_.set("X-Content-Type-Options", "nosniff");
        response_.set("Referrer-Policy", "no-referrer");
        response_.set("Cross-Origin-Opener-Policy", "same-origin");
        response_.set("Cross-Origin-Resource-Policy", "same-origin");
        response_.set(
            "Content-Security-Policy",
            "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; "
            "connect-src 'self' data: blob:; worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
        if (is_page)
            response_.set(http::field::set_cookie,
                          state_->cookie() + "=" + state_->token + "; HttpOnly; SameSite=Strict; Path=/");
        response_.keep_alive(false);
        response_.body() = std::move(text);
        response_.prepare_payload();
        stream_.expires_after(std::chrono::seconds(30));
        http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
            error_code ignored;
            self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream_;
    std::shared_ptr<WorkbenchServer::State> state_;
    beast::flat_buffer buffer_{65536};
    http::request_parser<http::empty_body> parser_;
    http::response<http::string_body> response_;
};

}  // namespace

void WorkbenchServer::State::accept() {
    acceptor.async_accept([self = shared_from_this()](error_code error, tcp::socket socket) {
        if (!self->acceptor.is_open()) return;
        if (!error) {
            const bool full = self->connections >= self->limits.connections;
            // Beyond twice the limit nobody is told.
            if (self->connections < 2 * self->limits.connections) std::make_shared<Visit>(std::move(socket), self)->begin(full);
        }
        self->accept();
    });
}

void WorkbenchServer::State::tell_all(const std::string& text, const Peer* but) {
    const auto message = std::make_shared<const std::string>(text);
    for (const auto& peer : peers)
        if (peer.get() != but) peer->send({message, true});
}

/// The thread that the workbench works on.
void WorkbenchServer::State::work() {
    workbench.on_progress = [self = shared_from_this()](const std::string& phase, double share) {
        Json event(rapidjson::kObjectType);
        add_members(event, event.GetAllocator(), "event", "progress", "phase", phase, "share", share);
        asio::post(self->io, [self, text = to_compact_text(event)] { self->tell_all(text); });
    };
    workbench.prepare();
    for (;;) {
        Request request;
        {
            std::unique_lock lock(mutex);
            wakes.wait(lock, [&] { return ends || !requests.empty(); });
            if (ends) return;
            request = std::move(requests.front());
            requests.pop_front();
        }
        const Workbench::Reply reply = workbench.answer(request.text);
        const Outgoing message{reply.bytes.empty() ? std::make_shared<const std::string>(reply.json) : packed(reply),
                               reply.bytes.empty()};
        asio::post(io, [self = shared_from_this(), from = request.from, message, changed = reply.changed,
                        place = workbench.session().place()] {
            const auto peer = from.lock();
            if (peer) {
                peer->answered();
                if (self->peers.contains(peer)) peer->send(message);
            }
            if (changed) self->tell_all(R"({"event":"changed","place":)" + std::to_string(place) + "}", peer.get());
        });
    }
}

WorkbenchServer::WorkbenchServer(Workbench& workbench, std::uint16_t port, const ServerLimits& limits)
    : state_(std::make_shared<State>(workbench, limits)) {
    error_code error;
    const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
    state_->acceptor.open(here.protocol(), error);
    if (!error) state_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) state_->acceptor.bind(here, error);
    if (!error) state_->acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error)
        throw Error(ErrorKind::failure, "port " + std::to_string(port), "cannot be had: " + error.message(),
                    "leave --port out, or give another one");
    state_->port = state_->acceptor.local_endpoint().port();
}

WorkbenchServer::~WorkbenchServer() = default;

std::string WorkbenchServer::address() const {
    return "http://127.0.0.1:" + std::to_string(state_->port) + "/?token=" + state_->token;
}
std::uint16_t WorkbenchServer::port() const { return state_->port; }
const std::string& WorkbenchServer::token() const { return state_->token; }

void WorkbenchServer::run() {
    std::thread worker([state = state_] { state->work(); });
    state_->accept();
    state_->io.run();
    {
        const std::lock_guard lock(state_->mutex);
        state_->ends = true;
    }
    state_->wakes.notify_one();
    worker.join();
    state_->workbench.on_progress = {};
}

void WorkbenchServer::stop() {
    state_->workbench.cancel();
    asio::post(state_->io, [state = state_] {
        error_code ignored;
        state->acceptor.close(ignored);
        for (const auto& peer : state->peers) peer->close();
        state->peers.clear();
        state->io.stop();
    });
}

}  // namespace ostraka
