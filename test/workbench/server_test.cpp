// The server against unauthorised clients and invalid requests.
#include "meshes.h"
#include "scratch.h"

#include "ostraka/core/memory.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/page/content_policy.h"
#include "ostraka/workbench/server.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A server on a folder with one mesh, on a separate thread.
struct Served {
    Scratch scratch;
    std::unique_ptr<Workbench> workbench;
    std::unique_ptr<WorkbenchServer> server;
    std::thread thread;
    explicit Served(const ServerLimits& limits = {}, int levels = 3) {
        write_mesh(scratch / "ball.ply", build_mesh(octahedron_sphere(levels)), {}, {});
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

/// A connection that sends and receives bytes.
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
    /// Received bytes until the other side closes, the requested number has arrived, or nothing arrives for some seconds.
    std::string receive(std::size_t wanted = 1U << 30U, int patience = 10000) {
        std::string all;
        char part[65536];
        while (all.size() < wanted) {
            pollfd waiting{socket_, POLLIN, 0};
            if (::poll(&waiting, 1, patience) <= 0) break;
            const ssize_t got = ::recv(socket_, part, std::min(sizeof part, wanted - all.size()), 0);
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
            const bool is_short = size < 65536;
            frame += static_cast<char>(0x80U | (is_short ? 126U : 127U));
            for (int k = is_short ? 1 : 7; k >= 0; --k) frame += static_cast<char>(size >> (8 * static_cast<unsigned>(k)) & 255U);
        }
        frame += std::string(4, '\0');  // masked with zeros
        return send(frame + text);
    }
    /// A message from the server, text or not, whatever number of frames it comes in.
    std::string hear() {
        std::string message;
        for (bool is_last = false; !is_last;) {
            const std::string head = receive(2);
            if (head.size() < 2) return {};
            is_last = (static_cast<unsigned char>(head[0]) & 128U) != 0;
            const std::size_t marked = static_cast<unsigned char>(head[1]) & 127U;
            std::size_t size = marked < 126 ? marked : 0;
            if (marked >= 126)
                for (const char byte : receive(marked == 126 ? 2 : 8)) size = size << 8U | static_cast<unsigned char>(byte);
            const std::string part = receive(size);
            if (part.size() < size) return {};
            message += part;
        }
        return message;
    }

    /// The next answer; events are skipped.
    std::string answer() {
        std::string message = hear();
        while (message.starts_with("{\"event\"")) message = hear();
        return message;
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
/// An authorised page.
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
    return wire->answer().find("\"id\":7") != std::string::npos;
}

}  // namespace

TEST(WorkbenchServer, ServesThePageToClientsWithTheToken) {
    const Served served;
    const std::string token = served.server->token();
    EXPECT_EQ(token.size(), 64U);
    Wire wire(served.server->port());
    wire.send(get(served, "/?token=" + token));
    const std::string answer = wire.receive();
    EXPECT_EQ(status(answer), 200);
    EXPECT_NE(answer.find(workbench_page()), std::string::npos);
    EXPECT_NE(answer.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(ask(served, get(served, "/?a=b&token=" + token)), 200) << "as a reload asks";
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, SetsAndAcceptsNoCookie) {
    // Browsers send the cookies of one port of a machine to all its ports.
    const Served served;
    const std::string token = served.server->token(), origin = "http://" + served.host();
    const std::string cookie =
        "Cookie: token=" + token + "; ostraka-" + std::to_string(served.server->port()) + "=" + token + "\r\n";
    Wire wire(served.server->port());
    wire.send(get(served, "/?token=" + token));
    const std::string answer = wire.receive(), head = answer.substr(0, answer.find("\r\n\r\n"));
    EXPECT_EQ(head.find("ookie"), std::string::npos) << head;
    EXPECT_EQ(head.find(token), std::string::npos) << head;
    EXPECT_EQ(ask(served, get(served, "/", cookie)), 403);
    std::string talk = upgrade(served, origin, "");
    talk.insert(talk.size() - 2, cookie);
    EXPECT_EQ(ask(served, talk), 403);
}

TEST(WorkbenchServer, RunsOnlyTheScriptOfItsPage) {
    const Served served;
    Wire wire(served.server->port());
    wire.send(get(served, "/?token=" + served.server->token()));
    const std::string answer = wire.receive(), head = answer.substr(0, answer.find("\r\n\r\n"));
    EXPECT_NE(head.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(head.find("unsafe-inline"), std::string::npos) << head;
    EXPECT_EQ(head.find("unsafe-eval"), head.find("wasm-unsafe-eval") + 5) << head;
    const std::string scripts = inline_hashes(workbench_page(), "script");
    EXPECT_EQ(scripts.size(), std::string("'sha256-'").size() + 44) << "the page has one script";
    EXPECT_NE(head.find("script-src " + scripts + " 'wasm"), std::string::npos) << head;
    EXPECT_NE(head.find("style-src " + inline_hashes(workbench_page(), "style") + ";"), std::string::npos) << head;
}

TEST(WorkbenchServer, RefusesUnauthorisedClients) {
    const Served served;
    const std::string token = served.server->token(), origin = "http://" + served.host();
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
        {page_of("Origin: " + origin + ".evil.example\r\n"), 403},
        {page_of("Origin: " + origin + "\r\n"), 200},
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
        {upgrade(served, origin, std::string(64, 'f')), 403},
        {upgrade(served, origin, token), 101},
    };
    for (const auto& [request, expected] : tried) {
        Wire wire(served.server->port());
        wire.send(request);
        EXPECT_EQ(status(wire.receive(12)), expected) << request.substr(0, 200);
    }
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, ReceivesAnnouncedFilesOnly) {
    const Served served;
    const std::string token = served.server->token(), origin = "http://" + served.host(), content = "ply of a page";
    const auto wire = page(served);
    wire->say(R"({"id":1,"do":"upload","files":[{"name":"scans/a.ply","size":)" + std::to_string(content.size()) +
              R"(},{"name":"scans/b.jpg","size":1000000}]})");
    const std::string announced = wire->answer();
    EXPECT_NE(announced.find(R"("batch":"u001","scans":[0])"), std::string::npos) << announced;
    const auto post = [&](const std::string& query, const std::string& body, const std::string& more, std::size_t claimed) {
        return "POST /upload?" + query + " HTTP/1.1\r\nHost: " + served.host() + "\r\n" + more +
               "Content-Length: " + std::to_string(claimed) + "\r\n\r\n" + body;
    };
    const std::string ours = "Origin: " + origin + "\r\n", first = "token=" + token + "&batch=u001&file=0";
    const std::size_t size = content.size();
    for (const auto& [request, expected] : std::vector<std::pair<std::string, int>>{
             {post("batch=u001&file=0", content, ours, size), 403},
             {post(first, content, "", size), 403},
             {post(first, content, "Origin: http://evil.example\r\n", size), 403},
             {post("token=" + token + "&batch=u001&file=2", content, ours, size), 404},
             {post("token=" + token + "&batch=u001&file=-1", content, ours, size), 404},
             {post("token=" + token + "&batch=u001&file=0x0", content, ours, size), 404},
             {post("token=" + token + "&batch=../u001&file=0", content, ours, size), 404},
             {post("token=" + token + "&batch=u002&file=0", content, ours, size), 404},
             {post("token=" + token, content, ours, size), 404},
             {post(first, "", ours, 5'000'000'000), 413},
             {"GET /upload?" + first + " HTTP/1.1\r\nHost: " + served.host() + "\r\n\r\n", 404},
             {post(first, content, ours, size), 200},
             {post(first, content, ours, size), 404},
         })
        EXPECT_EQ(ask(served, request), expected) << request.substr(0, 200);
    const Path folder = served.scratch / "session" / "uploads" / "u001" / "scans";
    EXPECT_EQ(read_file(folder / "a.ply"), content);
    {  // a page that goes in the middle of a file leaves nothing of it
        Wire broken(served.server->port());
        broken.send(post("token=" + token + "&batch=u001&file=1", std::string(5000, 'x'), ours, 1000000));
    }
    for (int i = 0; i < 100 && count_files(folder) > 1; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(count_files(folder), 1U);
    // Names that leave the folder, files without a scan, too many and too large files.
    for (const char* files :
         {R"([{"name":"../a.ply","size":1}])", R"([{"name":"/a.ply","size":1}])", R"([{"name":"","size":1}])",
          R"([{"name":"a//b.ply","size":1}])", R"([{"name":".a.ply","size":1}])", R"([{"name":"a\\b.ply","size":1}])",
          R"([{"name":"a.ply","size":5e9}])", R"([{"name":"a.ply"}])", R"([{"name":"a.ply","size":1},{"name":"a.ply","size":1}])",
          R"([{"name":"a.jpg","size":1}])", "[]"}) {
        wire->say(R"({"id":2,"do":"upload","files":)" + std::string(files) + "}");
        EXPECT_NE(wire->answer().find("\"ok\":false"), std::string::npos) << files;
    }
    // A file that was not sent is no input.
    wire->say(R"({"id":3,"do":"run","operation":"import","with":{"scan":[{"upload":"u001","name":"scans/b.jpg"}]}})");
    EXPECT_NE(wire->answer().find("was not sent completely"), std::string::npos);
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, SurvivesGarbageAndDisconnectedWriters) {
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
    {  // bytes that are not a message, and binary messages
        const auto wire = page(served);
        wire->send(std::string(4000, '\xff'));
        wire->receive();
        EXPECT_TRUE(wire->closed());
        const auto other = page(served);
        other->say("abc", 2);
        other->receive();
        EXPECT_TRUE(other->closed());
    }
    {  // text that is not a request is answered
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
            EXPECT_NE(wire->answer().find("\"ok\":false"), std::string::npos) << text;
        }
    }
    {  // clients that disconnect after a request
        for (int i = 0; i < 5; ++i) page(served)->say(R"({"id":1,"do":"open","name":"ball.ply"})");
    }
    {  // more requests than the limit of waiting ones
        const auto wire = page(served);
        for (int i = 0; i < 2000; ++i)
            if (!wire->say(R"({"id":1,"do":"hello"})")) break;
        std::string all = wire->receive(1U << 30U, 3000);
        EXPECT_TRUE(wire->closed());
    }
    EXPECT_TRUE(answers(served));
    // Requests sent before the page disconnected are completed.
    for (int i = 0; i < 100 && served.workbench->session().steps().size() < 5; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(served.workbench->session().steps().size(), 5U);
}

TEST(WorkbenchServer, NoClientCanOccupyAllConnections) {
    ServerLimits limits;
    limits.seconds = 3;
    const Served served(limits);
    const auto before = page(served);
    std::vector<std::unique_ptr<Wire>> many;
    for (int i = 0; i < 500; ++i) {
        many.push_back(std::make_unique<Wire>(served.server->port()));
        if (i % 2 == 0) many.back()->send("GET / HT");  // and no more
    }
    // Other clients do not wait until they are dropped, and connected pages are still served.
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(ask(served, get(served, "/?token=" + served.server->token())), 200);
    EXPECT_TRUE(answers(served));
    before->say(R"({"id":1,"do":"go","place":0})");
    EXPECT_NE(before->answer().find("\"ok\":true"), std::string::npos);
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
    // The oldest were dropped at once; the others are dropped after the time limit for the header.
    many.front()->receive(1, 0);
    EXPECT_TRUE(many.front()->closed());
    many.back()->receive(1, 10000);
    EXPECT_TRUE(many.back()->closed());
}

TEST(WorkbenchServer, NoClientCanDisplaceAPage) {
    const Served served;
    std::atomic<bool> ends = false;
    std::thread crowd([&] {
        std::deque<Wire> wires;
        while (!ends) {
            wires.emplace_back(served.server->port());
            if (wires.size() > 200) wires.pop_front();
        }
    });
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(answers(served)) << i;
    ends = true;
    crowd.join();
}

TEST(WorkbenchServer, RefusesMorePagesThanItServes) {
    ServerLimits limits;
    limits.pages = 2;
    const Served served(limits);
    const auto first = page(served);
    {
        const auto second = page(served);
        EXPECT_EQ(ask(served, upgrade(served, "http://" + served.host(), served.server->token())), 503);
    }
    for (int i = 0; i < 100 && ask(served, get(served, "/?token=" + served.server->token())) != 200; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, BoundsTheMemoryForAPageThatDoesNotRead) {
    ServerLimits limits;
    limits.unsent = 1'000'000;
    limits.stalled = 3;
    const Served served(limits, 7);
    const auto slow = page(served), other = page(served);
    other->say(R"({"id":1,"do":"open","name":"ball.ply"})");
    EXPECT_NE(other->answer().find("\"ok\":true"), std::string::npos);
    const double before = resident_memory();
    // Two megabytes each: 120 MB of unread answers.
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(slow->say(R"({"id":2,"do":"scene","known":[]})"));
    double most = 0;
    for (int i = 0; i < 20; ++i) {
        other->say(R"({"id":3,"do":"go","place":1})");
        EXPECT_NE(other->answer().find("\"id\":3"), std::string::npos) << "others are answered";
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        most = std::max(most, resident_memory() - before);
    }
    EXPECT_LT(most, 40e6);
    // It is dropped, without waiting for its close message.
    bool gone = false;
    for (int i = 0; i < 100 && !gone; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        gone = !slow->say(R"({"do":"cancel"})");
    }
    EXPECT_TRUE(gone);
    EXPECT_TRUE(answers(served));
}

TEST(WorkbenchServer, SendsLargeAnswersToReadingClients) {
    ServerLimits limits;
    limits.unsent = 100'000;
    const Served served(limits, 8);
    const auto wire = page(served);
    wire->say(R"({"id":1,"do":"open","name":"ball.ply"})");
    EXPECT_NE(wire->answer().find("\"ok\":true"), std::string::npos);
    for (int i = 0; i < 5; ++i) wire->say(R"({"id":2,"do":"scene","known":[]})");
    std::string first;
    for (int i = 0; i < 5; ++i) {
        const std::string scene = wire->answer();
        EXPECT_GT(scene.size(), 6'000'000U);
        if (first.empty()) first = scene;
        EXPECT_TRUE(scene == first) << "answer " << i << " of " << scene.size() << " bytes";
    }
}

TEST(WorkbenchServer, BoundsTheBytesOfRequests) {
    for (const bool of_all : {false, true}) {
        ServerLimits limits;
        limits.seconds = 1;  // for who does not answer that it is let go
        (of_all ? limits.queue_bytes : limits.waiting_bytes) = 10'000;
        const Served served(limits);
        const auto wire = page(served);
        wire->say(R"({"id":1,"do":"hello","more":")" + std::string(9'000, 'x') + "\"}");
        EXPECT_NE(wire->answer().find("\"ok\":true"), std::string::npos);
        wire->say(R"({"id":1,"do":"hello","more":")" + std::string(10'000, 'x') + "\"}");
        wire->receive();
        EXPECT_TRUE(wire->closed());
        EXPECT_TRUE(answers(served));
    }
}

TEST(WorkbenchServer, ReportsTheFirstPageOnce) {
    Scratch scratch;
    Workbench workbench(scratch / "session", scratch.path());
    WorkbenchServer server(workbench);
    std::atomic<int> notifications = 0;
    server.on_first_page = [&] { ++notifications; };
    std::thread thread([&] { server.run(); });
    const std::string host = "127.0.0.1:" + std::to_string(server.port());
    for (int i = 0; i < 3; ++i) {
        Wire wire(server.port());
        wire.send("GET /messages?token=" + server.token() + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
                  "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                  "dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
        EXPECT_EQ(status(wire.receive(12)), 101);
    }
    server.stop();
    thread.join();
    EXPECT_EQ(notifications, 1);
}
