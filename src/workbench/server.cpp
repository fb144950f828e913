// The only file that uses Boost.Beast.
#include "ostraka/workbench/server.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/page/content_policy.h"

#include <fmt/core.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <list>
#include <optional>
#include <random>
#include <set>
#include <thread>
#include <utility>

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

/// Compares in time that depends on the length only, not on the content.
bool same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing |= static_cast<unsigned>(a[i] ^ b[i]);
    return differing == 0;
}

std::string_view view_of(boost::string_view text) { return {text.data(), text.size()}; }

/// The value of NAME in "a=b&NAME=value".
std::string_view value_in(std::string_view text, std::string_view name) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('&'), text.size());
        const std::string_view part = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (part.size() > name.size() && part.starts_with(name) && part[name.size()] == '=') return part.substr(name.size() + 1);
    }
    return {};
}

std::chrono::milliseconds milliseconds(double seconds) { return std::chrono::milliseconds(static_cast<long>(1000 * seconds)); }

/// A message to a page. Its parts, none of them empty, are sent in order.
struct Outgoing {
    std::vector<std::string> parts;
    bool is_text = true;
    [[nodiscard]] std::size_t size() const {
        std::size_t total = 0;
        for (const std::string& part : parts) total += part.size();
        return total;
    }
};
using Message = std::shared_ptr<const Outgoing>;

Message text_message(std::string text) { return std::make_shared<const Outgoing>(Outgoing{{std::move(text)}, true}); }

/// Text, or binary: [length of the JSON, 4 bytes][JSON, padded with blanks so that 4 + length is a multiple of 8][bytes].
Message message_of(Workbench::Reply&& reply) {
    if (reply.bytes.empty()) return text_message(std::move(reply.json));
    std::string& json = reply.json;
    while ((json.size() + 4) % 8 != 0) json += ' ';
    const auto size = static_cast<std::uint32_t>(json.size());
    std::string head;
    for (unsigned k = 0; k < 4; ++k) head += static_cast<char>(size >> 8 * k & 255);
    json.insert(0, head);
    return std::make_shared<const Outgoing>(Outgoing{{std::move(json), std::move(reply.bytes)}, false});
}

/// Unsent data of a page, for the worker thread.
struct Backlog {
    std::atomic<std::size_t> unsent{0};
    std::atomic<bool> gone{false};
    std::size_t turn = 0;  ///< when one of its requests was last started; used by the worker thread only
};

/// Whether the request leaves the session unchanged: then it is discarded if its page has gone.
bool is_read_only(const std::string& request) {
    static const std::set<std::string> words{"hello",     "scene", "select", "handles", "parts",
                                             "influence", "reach", "grab",   "drag",    "file"};
    try {
        const Json document = parse_json(request, "the request");
        return !document.IsObject() || words.contains(text_in(document, "do"));
    } catch (const Error&) {
        return true;
    }
}

}  // namespace

class Peer;
class Visit;

struct WorkbenchServer::State : std::enable_shared_from_this<WorkbenchServer::State> {
    State(Workbench& w, const ServerLimits& l);

    Workbench& workbench;
    ServerLimits limits;
    asio::io_context io{1};
    tcp::acceptor acceptor;
    asio::steady_timer pause{io};  ///< delay before accepting again after a failed accept
    std::string token, policy;
    std::uint16_t port = 0;
    std::function<void()> on_first_page;
    std::atomic<bool> progress_pending{false};  ///< a progress message is pending

    // Used by the network thread only.
    std::list<Visit*> unauthenticated;  ///< oldest first
    std::list<Visit*> served;           ///< authenticated; receive the page
    std::set<Peer*> peers;

    std::mutex mutex;
    std::condition_variable request_ready;
    struct Request {
        std::weak_ptr<Peer> from;
        std::shared_ptr<Backlog> backlog;
        std::string text;
        /// Size counted in the queue.
        [[nodiscard]] std::size_t bytes() const { return text.size() + 256; }
    };
    std::deque<Request> requests;
    std::size_t queued = 0;  ///< total bytes of `requests`
    std::size_t turns = 0;   ///< number of requests started
    bool stopping = false;

    void accept();
    void start_visit(tcp::socket&& socket);
    bool queue(Request request);
    std::optional<Request> next();
    void wake();
    void work();
    void answered(const std::weak_ptr<Peer>& from, std::size_t bytes, const Message& message, const Message& changed);
    void tell_progress(const Message& message);
    void drop_all();
    [[nodiscard]] bool is_full() const { return served.size() + peers.size() >= limits.pages; }
    [[nodiscard]] bool is_own_host(std::string_view host) const {
        const std::string port_suffix = ":" + std::to_string(port);
        return host == "127.0.0.1" + port_suffix || host == "localhost" + port_suffix;
    }
    [[nodiscard]] bool is_own_origin(std::string_view origin) const {
        return origin.starts_with("http://") && is_own_host(origin.substr(7));
    }
};

/// A WebSocket connection of a page.
class Peer : public std::enable_shared_from_this<Peer> {
public:
    Peer(tcp::socket&& socket, std::shared_ptr<WorkbenchServer::State> state)
        : stream_(std::move(socket)), state_(std::move(state)), timer_(state_->io) {
        state_->peers.insert(this);
    }
    ~Peer() { state_->peers.erase(this); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    void begin(const http::request<http::empty_body>& head) {
        websocket::stream_base::timeout timeout{};
        timeout.handshake_timeout = milliseconds(state_->limits.seconds);
        timeout.idle_timeout = std::chrono::seconds(60);  // open pages answer pings; dead connections are closed
        timeout.keep_alive_pings = true;
        stream_.set_option(timeout);
        stream_.read_message_max(state_->limits.message);
        stream_.auto_fragment(false);
        error_code ignored;
        beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
        stream_.async_accept(head, [self = shared_from_this()](error_code error) {
            if (error) return self->drop();
            self->open_ = true;
            if (const auto callback = std::exchange(self->state_->on_first_page, {})) callback();
            self->read();
        });
    }

    /// Sends an answer whose size the backlog already includes.
    void send(const Message& message) {
        if (!open_) return;
        outgoing_.push_back(message);
        write();
    }
    /// Progress is only useful immediately: a page with unsent messages gets none.
    void tell_progress(const Message& message) {
        if (open_ && outgoing_.empty()) add(message);
    }
    /// Reports that the session is at another step; only the latest report is kept.
    void tell_changed(const Message& message) {
        changed_ = message;
        write();
    }
    void answered(std::size_t bytes) { --waiting_, waiting_bytes_ -= bytes; }

    void close(const websocket::close_reason& why) {
        if (!open_) return;
        leave();
        wait(state_->limits.seconds);  // for the reply to the close frame, which may not come
        stream_.async_close(why, [self = shared_from_this()](error_code) { self->end_wait(); });
    }
    /// Closes the connection immediately.
    void drop() {
        leave();
        end_wait();
        beast::get_lowest_layer(stream_).close();
    }

private:
    static constexpr std::size_t frame = 1U << 18U;  ///< bytes per write; progress between writes shows that the page still reads

    void read() {
        stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) { self->handle_read(error); });
    }
    void handle_read(error_code error) {
        if (error) return drop();
        if (!open_) return;
        std::string text = beast::buffers_to_string(buffer_.data());
        buffer_.consume(buffer_.size());
        if (!stream_.got_text()) return refuse("messages are text");
        if (text == R"({"do":"cancel"})") {
            state_->workbench.cancel();
            return read();
        }
        ++waiting_, waiting_bytes_ += text.size();
        if (waiting_ > state_->limits.waiting || waiting_bytes_ > state_->limits.waiting_bytes ||
            !state_->queue({weak_from_this(), backlog_, std::move(text)}))
            return refuse("too many requests at once");
        read();
    }
    void refuse(const char* why) { close({websocket::close_code::policy_error, why}); }

    void add(const Message& message) {
        backlog_->unsent += message->size();
        send(message);
    }
    void write() {
        if (!open_ || is_writing_) return;
        if (outgoing_.empty() && changed_) return add(std::exchange(changed_, {}));
        if (outgoing_.empty()) return;
        const Outgoing& message = *outgoing_.front();
        if (part_ == 0 && place_ == 0) stream_.text(message.is_text);
        const std::string& part = message.parts[part_];
        const std::size_t size = std::min(part.size() - place_, frame);
        const bool is_last = part_ + 1 == message.parts.size() && place_ + size == part.size();
        is_writing_ = true;
        wait(state_->limits.stalled);
        stream_.async_write_some(
            is_last, asio::buffer(part.data() + place_, size),
            [self = shared_from_this(), size, is_last](error_code error, std::size_t) { self->wrote(error, size, is_last); });
    }
    void wrote(error_code error, std::size_t size, bool is_last) {
        is_writing_ = false;
        if (error) return drop();
        if (!open_) return outgoing_.clear();  // closing; its timer continues
        end_wait();
        const std::size_t before = backlog_->unsent.fetch_sub(size);
        if (before > state_->limits.unsent && before - size <= state_->limits.unsent) state_->wake();
        place_ += size;
        if (place_ == outgoing_.front()->parts[part_].size()) ++part_, place_ = 0;
        if (is_last) outgoing_.pop_front(), part_ = 0;
        write();
    }
    /// Drops the page after this time unless the timer is restarted or cancelled.
    void wait(double seconds) {
        timer_.expires_after(milliseconds(seconds));
        timer_.async_wait([self = shared_from_this()](error_code error) {
            if (!error && self->timer_.expiry() <= std::chrono::steady_clock::now()) self->drop();
        });
    }
    /// Cancels `wait`, even if the time has just expired.
    void end_wait() { timer_.expires_at(asio::steady_timer::time_point::max()); }
    /// Stops receiving and sending.
    void leave() {
        open_ = false;
        changed_.reset();
        outgoing_.resize(std::min<std::size_t>(outgoing_.size(), is_writing_ ? 1 : 0));
        if (!backlog_->gone.exchange(true)) state_->wake();
    }

    websocket::stream<beast::tcp_stream> stream_;
    std::shared_ptr<WorkbenchServer::State> state_;
    asio::steady_timer timer_;
    std::shared_ptr<Backlog> backlog_ = std::make_shared<Backlog>();
    beast::flat_buffer buffer_;
    std::deque<Message> outgoing_;
    Message changed_;
    std::size_t part_ = 0, place_ = 0;  ///< position within the first message
    bool open_ = false, is_writing_ = false;
    std::size_t waiting_ = 0, waiting_bytes_ = 0;
};

/// One HTTP request, for the page or for a WebSocket upgrade.
class Visit : public std::enable_shared_from_this<Visit> {
public:
    Visit(tcp::socket&& socket, std::shared_ptr<WorkbenchServer::State> state)
        : stream_(std::move(socket)), state_(std::move(state)), list_(&state_->unauthenticated) {
        place_ = list_->insert(list_->end(), this);
        parser_.header_limit(static_cast<std::uint32_t>(state_->limits.header));
        parser_.body_limit(UploadLimits().file_bytes);
    }
    ~Visit() {
        leave();
        discard_upload();
    }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

    void begin() {
        stream_.expires_after(milliseconds(state_->limits.seconds));
        http::async_read_header(stream_, buffer_, parser_,
                                [self = shared_from_this()](error_code error, std::size_t) { self->handle_head(error); });
    }
    void drop() {
        leave();
        stream_.close();
    }

private:
    void leave() {
        if (list_ != nullptr) list_->erase(place_);
        list_ = nullptr;
    }
    void handle_head(error_code error) {
        if (!stream_.socket().is_open()) return;
        if (error == http::error::header_limit)
            return answer(http::status::request_header_fields_too_large, "the request head is too long\n");
        if (error == http::error::body_limit) return answer(http::status::payload_too_large, "the file is too large\n");
        if (error == http::error::end_of_stream || error == beast::error::timeout) return;
        if (error) return answer(http::status::bad_request, "not understood\n");
        const auto& head = parser_.get();
        const std::string_view target = view_of(head.target()), host = view_of(head[http::field::host]);
        if (!state_->is_own_host(host)) return answer(http::status::misdirected_request, "this is another host\n");
        const bool is_upload = head.method() == http::verb::post && target.starts_with("/upload?");
        const bool has_body = parser_.chunked() || parser_.content_length().value_or(0) > 0;
        if (!is_upload && (head.method() != http::verb::get || has_body))
            return answer(http::status::method_not_allowed, "only GET\n");
        const auto origin = head.find(http::field::origin);
        if (origin != head.end() && !state_->is_own_origin(view_of(origin->value())))
            return answer(http::status::forbidden, "requested by another page\n");
        const std::size_t mark = target.find('?');
        const std::string_view path = target.substr(0, mark),
                               query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
        if (path.find("..") != std::string_view::npos || path.find('%') != std::string_view::npos ||
            path.find('\\') != std::string_view::npos)
            return answer(http::status::bad_request, "not understood\n");
        if (path != "/" && path != "/messages" && !is_upload) return answer(http::status::not_found, "there is nothing here\n");
        if (!same_secret(value_in(query, "token"), state_->token))
            return answer(http::status::forbidden, "open the address that 'ostraka workbench' shows: it holds a token\n");
        if (state_->is_full()) return answer(http::status::service_unavailable, "too many pages are open\n");
        if (path == "/") return serve();
        if (is_upload && origin == head.end()) return answer(http::status::forbidden, "not requested by a page\n");
        if (is_upload) return receive(value_in(query, "batch"), value_in(query, "file"));
        if (!websocket::is_upgrade(head)) return answer(http::status::upgrade_required, "for messages only\n");
        if (origin == head.end()) return answer(http::status::forbidden, "not requested by a page\n");
        start_messages();
    }

    void serve() {
        state_->served.splice(state_->served.end(), *list_, place_);
        list_ = &state_->served;
        answer(http::status::ok, workbench_page(), "text/html; charset=utf-8");
    }
    void start_messages() {
        http::request<http::empty_body> upgrade;
        upgrade.base() = parser_.get().base();
        stream_.expires_never();
        std::make_shared<Peer>(stream_.release_socket(), state_)->begin(upgrade);
    }

    /// Receives a file that was announced as number `file` of a batch.
    void receive(std::string_view batch, std::string_view file) {
        std::size_t index = 0;
        const auto [end, code] = std::from_chars(file.data(), file.data() + file.size(), index);
        const bool is_number = code == std::errc() && end == file.data() + file.size() && !file.empty();
        const auto announced = is_number ? state_->workbench.uploads().begin(batch, index) : std::nullopt;
        if (!announced) return answer(http::status::not_found, "this file was not announced\n");
        if (parser_.chunked() || parser_.content_length().value_or(0) != announced->size)
            return answer(http::status::bad_request, "the size is not the announced one\n");
        state_->served.splice(state_->served.end(), *list_, place_);
        list_ = &state_->served;
        upload_path_ = announced->path;
        upload_.open(part_of_upload(), std::ios::binary | std::ios::trunc);
        if (!upload_) return answer(http::status::internal_server_error, "the file cannot be written\n");
        body_.emplace(std::move(parser_));
        body_->body_limit(announced->size);
        read_body();
    }
    void read_body() {
        chunk_.resize(1U << 18U);
        body_->get().body().data = chunk_.data();
        body_->get().body().size = chunk_.size();
        stream_.expires_after(milliseconds(state_->limits.stalled));
        http::async_read(stream_, buffer_, *body_,
                         [self = shared_from_this()](error_code error, std::size_t) { self->handle_body(error); });
    }
    void handle_body(error_code error) {
        if (error == http::error::need_buffer) error = {};
        if (error || !stream_.socket().is_open()) return discard_upload();
        upload_.write(chunk_.data(), static_cast<std::streamsize>(chunk_.size() - body_->get().body().size));
        if (!upload_) {
            discard_upload();
            return answer(http::status::insufficient_storage, "the file cannot be written: the disk may be full\n");
        }
        if (!body_->is_done()) return read_body();
        upload_.close();
        std::error_code code;
        std::filesystem::rename(part_of_upload(), upload_path_, code);
        if (code) return answer(http::status::internal_server_error, "the file cannot be written\n");
        upload_path_.clear();
        answer(http::status::ok, "received\n");
    }
    [[nodiscard]] Path part_of_upload() const { return upload_path_.string() + ".part"; }
    /// Removes what was received of a file that did not arrive completely.
    void discard_upload() {
        if (upload_path_.empty()) return;
        upload_.close();
        std::error_code ignored;
        std::filesystem::remove(part_of_upload(), ignored);
        upload_path_.clear();
    }

    /// `text` must outlive the response.
    void answer(http::status status, std::string_view text, const char* type = "text/plain; charset=utf-8") {
        response_.result(status);
        response_.version(11);
        response_.set(http::field::content_type, type);
        response_.set(http::field::cache_control, "no-store");
        response_.set("X-Content-Type-Options", "nosniff");
        response_.set("Referrer-Policy", "no-referrer");
        response_.set("Cross-Origin-Opener-Policy", "same-origin");
        response_.set("Cross-Origin-Resource-Policy", "same-origin");
        response_.set("Content-Security-Policy", state_->policy);
        response_.keep_alive(false);
        response_.body() = {text.data(), text.size()};
        response_.prepare_payload();
        stream_.expires_after(milliseconds(state_->limits.stalled));
        http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
            error_code ignored;
            self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream_;
    std::shared_ptr<WorkbenchServer::State> state_;
    std::list<Visit*>* list_;  ///< the list that counts this connection
    std::list<Visit*>::iterator place_;
    beast::flat_buffer buffer_{65536};
    http::request_parser<http::empty_body> parser_;
    std::optional<http::request_parser<http::buffer_body>> body_;  ///< of a file that is received
    std::vector<char> chunk_;
    std::ofstream upload_;
    Path upload_path_;  ///< the file that is received; empty: none
    http::response<http::span_body<const char>> response_;
};

WorkbenchServer::State::State(Workbench& w, const ServerLimits& l)
    : workbench(w), limits(l), acceptor(io), token(random_token()) {
    // Allows the scripts and styles of the built page only; WebAssembly decodes the 3D shapes.
    policy = fmt::format(
        "default-src 'none'; script-src {} 'wasm-unsafe-eval'; style-src {}; img-src data: blob:; connect-src 'self' data: "
        "blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        inline_hashes(workbench_page(), "script"), inline_hashes(workbench_page(), "style"));
}

void WorkbenchServer::State::accept() {
    acceptor.async_accept([self = shared_from_this()](error_code error, tcp::socket socket) {
        if (!self->acceptor.is_open()) return;
        if (!error) self->start_visit(std::move(socket));
        if (!error) return self->accept();
        // For instance no free file descriptor: retrying at once would use a full core.
        self->pause.expires_after(std::chrono::milliseconds(50));
        self->pause.async_wait([self](error_code stopped) {
            if (!stopped) self->accept();
        });
    });
}

void WorkbenchServer::State::start_visit(tcp::socket&& socket) {
    while (!unauthenticated.empty() && unauthenticated.size() >= limits.unauthenticated) unauthenticated.front()->drop();
    std::make_shared<Visit>(std::move(socket), shared_from_this())->begin();
}

/// Returns false if the queue is full.
bool WorkbenchServer::State::queue(Request request) {
    {
        const std::lock_guard lock(mutex);
        if (queued + request.bytes() > limits.queue_bytes) return false;
        queued += request.bytes();
        requests.push_back(std::move(request));
    }
    request_ready.notify_one();
    return true;
}

/// Waits for a request whose page keeps up with its answers; pages take turns. Returns none if the server ends.
std::optional<WorkbenchServer::State::Request> WorkbenchServer::State::next() {
    const auto ready = [&](const Request& request) { return request.backlog->gone || request.backlog->unsent <= limits.unsent; };
    std::unique_lock lock(mutex);
    auto chosen = requests.end();
    request_ready.wait(lock, [&] {
        chosen = requests.end();
        for (auto candidate = requests.begin(); candidate != requests.end(); ++candidate)
            if (ready(*candidate) && (chosen == requests.end() || candidate->backlog->turn < chosen->backlog->turn))
                chosen = candidate;
        return stopping || chosen != requests.end();
    });
    if (stopping) return std::nullopt;
    Request request = std::move(*chosen);
    requests.erase(chosen);
    queued -= request.bytes();
    request.backlog->turn = ++turns;
    return request;
}

/// Makes the worker thread check again whether a request is ready.
void WorkbenchServer::State::wake() {
    { const std::lock_guard lock(mutex); }
    request_ready.notify_one();
}

void WorkbenchServer::State::tell_progress(const Message& message) {
    progress_pending = false;
    for (Peer* peer : peers) peer->tell_progress(message);
}

/// `bytes`: size of the request.
void WorkbenchServer::State::answered(const std::weak_ptr<Peer>& from, std::size_t bytes, const Message& message,
                                      const Message& changed) {
    const auto peer = from.lock();
    if (peer) {
        peer->answered(bytes);
        peer->send(message);
    }
    if (!changed) return;
    for (Peer* other : peers)
        if (other != peer.get()) other->tell_changed(changed);
}

/// Main loop of the worker thread.
void WorkbenchServer::State::work() {
    workbench.on_progress = [self = shared_from_this()](const std::string& phase, double share) {
        if (self->progress_pending.exchange(true)) return;
        Json event(rapidjson::kObjectType);
        add_members(event, event.GetAllocator(), "event", "progress", "phase", phase, "share", share);
        asio::post(self->io, [self, message = text_message(to_compact_text(event))] { self->tell_progress(message); });
    };
    workbench.prepare();
    while (const auto request = next()) {
        if (request->backlog->gone && is_read_only(request->text)) continue;
        Workbench::Reply reply = workbench.answer(request->text);
        const Message changed =
            reply.changed ? text_message(R"({"event":"changed","place":)" + std::to_string(workbench.session().place()) + "}")
                          : Message();
        const Message message = message_of(std::move(reply));
        request->backlog->unsent += message->size();
        asio::post(io, [self = shared_from_this(), from = request->from, bytes = request->text.size(), message, changed] {
            self->answered(from, bytes, message, changed);
        });
    }
}

/// Closes all connections without waiting for the pages; their pending operations end when next run.
void WorkbenchServer::State::drop_all() {
    error_code ignored;
    acceptor.close(ignored);
    pause.cancel();
    while (!unauthenticated.empty()) unauthenticated.front()->drop();
    while (!served.empty()) served.front()->drop();
    for (Peer* peer : std::set<Peer*>(peers)) peer->drop();
}

WorkbenchServer::WorkbenchServer(Workbench& workbench, std::uint16_t port, const ServerLimits& limits)
    : state_(std::make_shared<State>(workbench, limits)) {
    error_code error;
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), port);
    state_->acceptor.open(endpoint.protocol(), error);
    if (!error) state_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) state_->acceptor.bind(endpoint, error);
    if (!error) state_->acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error)
        throw Error(ErrorKind::failure, "port " + std::to_string(port), "is not available: " + error.message(),
                    "leave out --port, or give another one");
    state_->port = state_->acceptor.local_endpoint().port();
}

WorkbenchServer::~WorkbenchServer() = default;

std::string WorkbenchServer::address() const { return fmt::format("http://127.0.0.1:{}/?token={}", state_->port, state_->token); }
std::uint16_t WorkbenchServer::port() const { return state_->port; }
const std::string& WorkbenchServer::token() const { return state_->token; }

void WorkbenchServer::run() {
    state_->on_first_page = on_first_page;
    std::thread worker([state = state_] { state->work(); });
    state_->accept();
    state_->io.run();
    {
        const std::lock_guard lock(state_->mutex);
        state_->stopping = true;
    }
    state_->request_ready.notify_one();
    worker.join();
    state_->workbench.on_progress = {};
    state_->drop_all();
    state_->io.restart();
    state_->io.poll();
}

void WorkbenchServer::stop() {
    state_->workbench.cancel();
    asio::post(state_->io, [state = state_] {
        error_code ignored;
        state->acceptor.close(ignored);
        for (Peer* peer : state->peers) peer->close({websocket::close_code::going_away, "the workbench ends"});
        state->io.stop();
    });
}

}  // namespace ostraka
