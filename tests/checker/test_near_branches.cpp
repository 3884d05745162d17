// Nearly equal disks: where some stand nearly in line two branches of the motion come near each other, and steps in
// double may end on the wrong one. Small steps from the equilibrium before tell them apart.
#include "support/played.hpp"
#include "support/prepared.hpp"

#include <tuple>

using namespace isostat;
namespace fs = std::filesystem;

namespace {

/// 36 disks, equal but for a jitter of 1e-9.
void play(std::uint64_t seed, int equilibria, const fs::path& folder) {
    PreparationOptions options{.disks = 36};
    options.diameters.kind = RadiiLaw::equal;
    options.jitter = 1e-9;
    options.seed = seed;
    BOOST_REQUIRE(played::into(folder, prepared(options), {towards(equilibria)}).completed);
}

} // namespace

BOOST_AUTO_TEST_CASE(ends_near_another_branch_are_proved_and_what_contradicts_them_is_not,
                     *boost::unit_test::label("slow")) {
    const scratch::Folder scratch_folder;
    // The arc in question leads to the last equilibrium: it opens this contact.
    for (const auto& [seed, equilibria, opened] :
         {std::tuple{11, 10, "1-31"}, std::tuple{29, 10, "12-34"}, std::tuple{37, 12, "5-7"}}) {
        BOOST_TEST_INFO_SCOPE("seed " << seed);
        const fs::path folder = scratch_folder / std::to_string(seed);
        play(static_cast<std::uint64_t>(seed), equilibria, folder);
        const RunVerification run = played::proved(folder);
        BOOST_TEST(run.equilibria_proved == equilibria + 1);
        const std::string events = scratch::read(folder / "events.jsonl");
        const std::size_t arc = events.rfind("\"opened\":\"" + std::string(opened));
        BOOST_TEST_REQUIRE(arc != std::string::npos);
        const std::size_t eps2 = events.find("\"eps2\":", arc) + 7;
        const std::string said = events.substr(eps2, events.find(',', eps2) - eps2);
        std::string other = said;
        other[9] = other[9] == '5' ? '6' : '5';
        const RunVerification forged = forger::altered(folder, "events.jsonl", said, other);
        BOOST_TEST((forged.verdict != Verdict::proved));
    }
}
