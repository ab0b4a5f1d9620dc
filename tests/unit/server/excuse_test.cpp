#include "server/http/excuse.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>

namespace modelsynth::server {
namespace {

class Excuse : public testing::Test {
  protected:
    Response answer(const std::function<Response()>& made) {
        return answer_or_excuse(request_, logger_, made);
    }

    std::string logged() {
        logger_.flush();
        return lines_.str();
    }

    Request request_ = [] {
        Request request;
        request.id = "0123456789abcdef";
        request.target = "/v1/jobs";
        return request;
    }();

  private:
    std::ostringstream lines_;
    spdlog::logger logger_{"test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines_)};
};

TEST_F(Excuse, IsNotMadeForAnAnswer) {
    const Response response = answer([] { return json_response(202, "{}"); });
    EXPECT_EQ(response.status, 202);
    EXPECT_EQ(logged(), "");
}

TEST_F(Excuse, IsMadeForAFaultAndTellsClientsNothingOfIt) {
    const Response response =
        answer([]() -> Response { throw std::logic_error("internal check failed: secret"); });
    EXPECT_EQ(response.status, 500);
    EXPECT_EQ(response.problem, "internal");
    const auto& body = std::get<std::string>(response.body);
    EXPECT_NE(body.find("\"instance\":\"/v1/jobs\""), std::string::npos) << body;
    EXPECT_EQ(body.find("secret"), std::string::npos) << body;
    EXPECT_NE(logged().find("internal check failed: secret"), std::string::npos) << logged();
    EXPECT_NE(logged().find("0123456789abcdef"), std::string::npos) << logged();
}

}  // namespace
}  // namespace modelsynth::server
