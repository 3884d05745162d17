#include "scene/seed.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/scene/scene.hpp>

using namespace isostat;

namespace {

std::string seeded(const std::string& text, std::uint64_t seed) {
    return with_seed(text, seed, "s.toml", "/somewhere");
}

void refused(const std::string& text, std::uint64_t seed, const std::string& word) {
    expect_bad_input([&] { (void)seeded(text, seed); }, {word});
}

} // namespace

BOOST_AUTO_TEST_CASE(only_the_seed_of_the_packing_changes) {
    const std::string text =
        "# größe\n[packing] # here\ndisks = 7\n  seed = 12 # of the sample\n[run]\nrule_seed = 12\n";
    BOOST_TEST(seeded(text, 345) ==
               "# größe\n[packing] # here\ndisks = 7\n  seed = 345 # of the sample\n[run]\nrule_seed = 12\n");
    BOOST_TEST(seeded(text, 12) == text);
    BOOST_TEST(seeded("packing = {seed = 1_0, disks = 3}", 2) == "packing = {seed = 2, disks = 3}");
    BOOST_TEST(seeded("packing.\"disks\" = 3\npacking.seed = 0x1F", 2) == "packing.\"disks\" = 3\npacking.seed = 2");
    BOOST_TEST(seeded("[\"packing\"]\n\"seed\"=1\ndisks = 3", 9223372036854775807U) ==
               "[\"packing\"]\n\"seed\"=9223372036854775807\ndisks = 3");
}

BOOST_AUTO_TEST_CASE(a_missing_seed_is_added) {
    BOOST_TEST(seeded("[packing] # ö\ndisks = 3\n", 4) == "[packing] # ö\nseed = 4\ndisks = 3\n");
    refused("packing = {disks = 3}", 4, "seed");
}

BOOST_AUTO_TEST_CASE(a_list_of_radii_stands_in_the_scene_of_a_sample) {
    const scratch::Folder folder;
    scratch::write(folder / "radii.txt", "1\n2.5\n");
    const std::string text = "[packing]\nradii_file = \"radii.txt\"\nseed = 3\n";
    const std::string expected = "[packing]\nradii = [1, 2.5]\nseed = 5\n";
    BOOST_TEST(with_seed(text, 5, "s.toml", folder.path()) == expected);
    BOOST_TEST(parse_scene(expected, "s.toml", "/elsewhere").preparation.radii.size() == 2U);
}

BOOST_AUTO_TEST_CASE(scenes_without_samples_are_refused) {
    refused("[packing]\nfile = \"start.json\"\n", 2, "start.json");
    refused("[packing]\ndisks = 3\nseed = 1\n", 9223372036854775808U, "9223372036854775808");
    refused("[packing]\ndisks = 3\nfly = 1\n", 2, "fly");
    refused("[packing\n", 2, "TOML");
}
