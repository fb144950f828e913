// The server against those who should not talk to it, and those who talk nonsense.
#include "meshes.h"
#include "scratch.h"

#include "ostraka/core/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/workbench/server.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A server on a folder with one mesh, on a thread of its own.
struct Served {
    Scratch scratch;
    std::unique_ptr<Workbench> workbench;
    std::unique_ptr<WorkbenchServer> server;
    std::thread thread;
    explicit Served(const ServerLimits& limits = {}) {
        write_mesh(scratch / "ball.ply", build_mesh(octahedron_sphere(3)), {}, {});
        workbench = std::make_unique<Workbench>(scratch / "session", scratch.path());
        server = std::make_unique<WorkbenchServer>(*workbench, 0, limits);
        thread = std::thread([this] { server->run(); });
    }
    ~Served() {
        server->stop();
        thread.join();
    }
    [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server->port()); }
};

/// A connection of bare bytes.
class Wire {
public:
    explicit Wire(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
        open_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    ~Wire() { ::close(socket_); }
    Wire(const Wire&) = delete;
    Wire& operator=(const Wire&) = delete;

    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    /// What comes until the other side closes, there is as much as wanted, or nothing came for some seconds.
    std::string receive(std::size_t wanted = 1U << 30U, int patience = 10000) {
        std::string all;
        char part[65536];
        while (all.size() < wanted) {
            pollfd waiting{socket_, POLLIN, 0};
            if (::poll(&waiting, 1, patience) <= 0) break;
            const ssize_t got = ::recv(socket_, part, sizeof part, 0);
            if (got <= 0) {
                closed_ = true;
                break;
            }
            all.append(part, static_cast<std::size_t>(got));
        }
        return all;
    }
    [[nodiscard]] bool closed() const { return closed_; }
    [[nodiscard]] bool open() const { return open_; }

    /// One message of a page: masked text. `opcode` 1: text, 2: binary.
    bool say(const std::string& text, unsigned opcode = 1, std::uint64_t claimed = 0) const {
        std::string frame;
        frame += static_cast<char>(0x80U | opcode);
        const std::uint64_t size = claimed > 0 ? claimed : text.size();
        if (size < 126) frame += static_cast<char>(0x80U | size);
        else {
            frame += static_cast<char>(0x80U | 127U);
            for (int k = 7; k >= 0; --k) frame += static_cast<char>(size >> (8 * static_cast<unsigned>(k)) & 255U);
        }
        frame += std::string(4, '\0');  // masked with zeros
        return send(frame + text);
    }
    /// A text message from the server.
    std::string hear() {
        std::string frame = receive(2);
        if (frame.size() < 2) return {};
        const auto byte = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<unsigned char>(frame[i])); };
        std::uint64_t size = byte(1) & 127U;
        std::size_t head = 2;
        const auto need = [&](std::size_t n) {
            while (frame.size() < n) {
                const std::string more = receive(n - frame.size());
                if (more.empty()) return false;
                frame += more;
            }
            return true;
        };
        if (size == 126) {
            if (!need(4)) return {};
            size = byte(2) << 8U | byte(3);
            head = 4;
        } else if (size == 127) {
            if (!need(10)) return {};
            size = 0;
            for (std::size_t k = 2; k < 10; ++k) size = size << 8U | byte(k);
            head = 10;
        }
        return need(head + size) ? frame.substr(head, size) : std::string();
    }

private:
    int socket_;
    bool open_ = false, closed_ = false;
};

std::string get(const Served& served, const std::string& target, const std::string& more = {}, const std::string& host = {}) {
    return "GET " + target + " HTTP/1.1\r\nHost: " + (host.empty() ? served.host() : host) + "\r\n" + more + "\r\n";
}
std::string upgrade(const Served& served, const std::string& origin, const std::string& token) {
    return get(served, "/messages?token=" + token,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
               "dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   (origin.empty() ? "" : "Origin: " + origin + "\r\n"));
}
int status(const std::string& answer) { return answer.size() < 12 ? 0 : std::atoi(answer.c_str() + 9); }
int ask(const Served& served, const std::string& request) {
    Wire wire(served.server->port());
    wire.send(request);
    return status(wire.receive());
}
/// A page that may talk.
std::unique_ptr<Wire> page(const Served& served) {
    auto wire = std::make_unique<Wire>(served.server->port());
    wire->send(upgrade(served, "http://" + served.host(), served.server->token()));
    std::string head;
    while (head.find("\r\n\r\n") == std::string::npos) {
        const std::string more = wire->receive(1);
        if (more.empty()) break;
        head += more;
    }
    EXPECT_EQ(status(head), 101) << head;
    return wire;
}
bool answers(const Served& served) {
    const auto wire = page(served);
    wire->say(R"({"id":7,"do":"go","place":0})");
    for (int i = 0; i < 20; ++i) {
        const std::string heard = wire->hear();
        if (heard.find("\"id\":7") != std::string::npos) return true;
        if (heard.empty()) return false;
    }
    return false;
}

}  // namespace

TEST(WorkbenchServer, GivesThePageToWhoKnowsTheToken) {
    const Served served;
    const std::string token = served.server->token();
    EXPECT_EQ(token.size(), 64U);
    Wire wire(served.server->port());
    wire.send(get(served, "/?token=" + token));
    const std::string answer = wire.receive();
    EXPECT_EQ(status(answer), 200);
    EXPECT_NE(answer.find(workbench_page()), std::string::npos);
    EXPECT_NE(answer.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(answer.find("HttpOnly; SameSite=Strict"), std::string::npos);
    EXPECT_EQ(
        ask(served, get(served, "/", "Cookie: a=b; ostraka-" + std::to_string(served.server->port()) + "=" + token + "\r\n")),
        200);
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, RefusesWhoShouldNotTalk) {
    const Served served;
    const std::string token = served.server->token(), own = "http://" + served.host();
    const auto page_of = [&](const std::string& more = {}, const std::string& host = {}) {
        return get(served, "/?token=" + token, more, host);
    };
    const std::vector<std::pair<std::string, int>> tried{
        {get(served, "/"), 403},
        {get(served, "/?token="), 403},
        {get(served, "/?token=" + std::string(64, '0')), 403},
        {get(served, "/?token=" + token.substr(0, 63)), 403},
        {get(served, "/?token=" + token + "0"), 403},
        {get(served, "/?other=" + token), 403},
        {page_of({}, "evil.example"), 421},
        {page_of({}, "127.0.0.1"), 421},
        {page_of({}, "127.0.0.1:1"), 421},
        {page_of({}, served.host() + ".evil.example"), 421},
        {page_of({}, "localhost:" + std::to_string(served.server->port())), 200},
        {"GET /?token=" + token + " HTTP/1.1\r\n\r\n", 421},
        {page_of("Origin: http://evil.example\r\n"), 403},
        {page_of("Origin: null\r\n"), 403},
        {page_of("Origin: https://" + served.host() + "\r\n"), 403},
        {page_of("Origin: " + own + ".evil.example\r\n"), 403},
        {page_of("Origin: " + own + "\r\n"), 200},
        {get(served, "/../etc/passwd?token=" + token), 400},
        {get(served, "/%2e%2e/etc/passwd?token=" + token), 400},
        {get(served, "/..%2fetc/passwd?token=" + token), 400},
        {get(served, "//etc/passwd?token=" + token), 404},
        {get(served, "/session/session.json?token=" + token), 404},
        {get(served, "/ball.ply?token=" + token), 404},
        {get(served, "/messages?token=" + token), 426},
        {"POST /?token=" + token + " HTTP/1.1\r\nHost: " + served.host() + "\r\nContent-Length: 3\r\n\r\nabc", 405},
        {"DELETE /?token=" + token + " HTTP/1.1\r\nHost: " + served.host() + "\r\n\r\n", 405},
        {page_of("X: " + std::string(20000, 'x') + "\r\n"), 431},
        {std::string(300, '\x01') + "\r\n\r\n", 400},
        {"GET\r\n\r\n", 400},
        {upgrade(served, "", token), 403},
        {upgrade(served, "http://evil.example", token), 403},
        {upgrade(served, own, std::string(64, 'f')), 403},
        {upgrade(served, own, token), 101},
    };
    for (const auto& [request, expected] : tried) {
        Wire wire(served.server->port());
        wire.send(request);
        EXPECT_EQ(status(wire.receive(12)), expected) << request.substr(0, 200);
    }
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, SurvivesGarbageAndGoneWriters) {
    ServerLimits limits;
    limits.seconds = 1;  // for who does not answer that it is let go
    const Served served(limits);
    {  // a message of a gigabyte, as announced, and begun
        const auto wire = page(served);
        wire->say(std::string(100000, 'x'), 1, 1ULL << 30U);
        for (int i = 0; i < 40 && wire->send(std::string(100000, 'x')); ++i) {
        }
        wire->receive();
        EXPECT_TRUE(wire->closed());
    }
    {  // bytes that are no message, and binary messages
        const auto wire = page(served);
        wire->send(std::string(4000, '\xff'));
        wire->receive();
        EXPECT_TRUE(wire->closed());
        const auto other = page(served);
        other->say("abc", 2);
        other->receive();
        EXPECT_TRUE(other->closed());
    }
    {  // text that is no request is answered
        const auto wire = page(served);
        for (const char* text :
             {"", "{", "null", "[]", "{\"do\":7}", "{\"id\":\"x\",\"do\":\"hello\",\"do\":\"\"}", "\xff\xfe"}) {
            if (std::string(text) == "\xff\xfe") {
                wire->say(text);
                wire->receive();
                EXPECT_TRUE(wire->closed()) << "text that is not UTF-8";
                break;
            }
            wire->say(text);
            EXPECT_NE(wire->hear().find("\"ok\":false"), std::string::npos) << text;
        }
    }
    {  // who asks and goes
        for (int i = 0; i < 5; ++i) page(served)->say(R"({"id":1,"do":"open","name":"ball.ply"})");
    }
    {  // more requests than may wait
        const auto wire = page(served);
        for (int i = 0; i < 2000; ++i)
            if (!wire->say(R"({"id":1,"do":"hello"})")) break;
        std::string all = wire->receive(1U << 30U, 3000);
        EXPECT_TRUE(wire->closed());
    }
    EXPECT_TRUE(answers(served));
    // What was asked before its page was gone is done.
    for (int i = 0; i < 100 && served.workbench->session().steps().size() < 5; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(served.workbench->session().steps().size(), 5U);
}

TEST(WorkbenchServer, LetsNobodyTakeAllConnections) {
    ServerLimits limits;
    limits.seconds = 2;
    const Served served(limits);
    std::vector<std::unique_ptr<Wire>> many;
    for (int i = 0; i < 200; ++i) {
        many.push_back(std::make_unique<Wire>(served.server->port()));
        many.back()->send("GET / HT");  // and no more
    }
    // They are let go after the time for a head; then there is room again.
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    EXPECT_TRUE(answers(served));
    many.clear();
    EXPECT_TRUE(answers(served));
}
