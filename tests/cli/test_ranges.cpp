// Numbers on the command line: finite, all of their word, in their range.
#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
namespace fs = std::filesystem;

namespace {

struct Called {
    const scratch::Folder folder;
    std::string state = folder.at("state.json"), out = folder.at("out");
    Called() { scratch::write(state, isostat::state_text(::crafted::two_disks(1, 2, 1, 1), {})); }
    /// Each option with the words that its command needs besides.
    [[nodiscard]] std::vector<std::vector<std::string>> with_numbers() const {
        return {{"inspect", state, "--at"},
                {"report", out, "--stiffness"},
                {"snap", state, "-o", out, "--stiffness"},
                {"import", state, "-o", out, "--jitter"},
                {"import", state, "-o", out, "--threshold"},
                {"genericity", state, "--stress"},
                {"genericity", state, "--size"}};
    }
    [[nodiscard]] std::vector<std::vector<std::string>> with_integers() const {
        return {{"inspect", state, "--threads"},
                {"ensemble", state, "-o", out, "--samples"},
                {"ensemble", state, "-o", out, "--samples", "1", "--jobs"},
                {"ensemble", state, "-o", out, "--samples", "1", "--first-seed"},
                {"import", state, "-o", out, "--seed"},
                {"snap", state, "-o", out, "--seed"},
                {"genericity", state, "--seed"},
                {"genericity", state, "--samples"},
                {"genericity", state, "--lists"},
                {"plateau", state, "--rows"},
                {"compare", state, "--bundle"},
                {"compare", state, "--frames"},
                {"plateau", state, "--frame"}};
    }
};

void refuses(std::vector<std::string> call, const std::string& word) {
    const std::string option = call.back();
    call.back() += "=" + word;
    const Outcome outcome = run(call);
    BOOST_TEST(outcome.status == 64, option << " " << word << ": " << outcome.status << " " << outcome.err);
    BOOST_TEST(contains(outcome.err, option), outcome.err);
}

} // namespace

BOOST_AUTO_TEST_CASE(numbers_of_options_are_finite_and_in_their_range) {
    const Called called;
    for (const auto& call : called.with_numbers()) {
        for (const char* word :
             {"nan", "NaN", "inf", "-inf", "infinity", "1e400", "1e101", "0x1p3", "1,5x", "1 2", "one"}) {
            refuses(call, word);
        }
    }
    for (const auto& call : {std::vector<std::string>{"report", called.out, "--stiffness"},
                             {"snap", called.state, "-o", called.out, "--stiffness"}}) {
        for (const char* word : {"1e-320", "0", "-1", "1e-101"}) {
            refuses(call, word);
        }
    }
    refuses({"import", called.state, "-o", called.out, "--jitter"}, "0.11");
    for (const char* word : {"nan,1", "1,inf", "1", "1,2,3", "0,1", "1e-320,1"}) {
        refuses({"snap", called.state, "-o", called.out, "--stress"}, word);
    }
    for (const char* word : {"nan:1", "0:inf", "1:0", "1"}) {
        refuses({"plateau", called.state, "--thresholds"}, word);
    }
    expect(run({"inspect", called.state, "--at", "1.5"}), 0);
    expect(run({"inspect", called.state, "--at=-1e98"}), 1);
    expect(run({"inspect", called.state, "--at=-1e100"}), 2); // times a length it is beyond what is computed with
}

BOOST_AUTO_TEST_CASE(integers_of_options_are_written_as_integers) {
    const Called called;
    for (const auto& call : called.with_integers()) {
        for (const char* word : {"4.9", "4.0", "1e1", "-0", "+4", "010", "0x10", "nan", "99999999999999999999", "4 "}) {
            refuses(call, word);
        }
    }
    expect(run({"inspect", called.state, "--threads", "1"}), 0);
}
