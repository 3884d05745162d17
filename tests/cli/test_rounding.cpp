// What the digits of a file leave open is not called proved.
#include "cli/program.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <nlohmann/json.hpp>

using namespace program;
using namespace isostat;
using Answer = nlohmann::json;

namespace {

std::string file_of(const std::string& name) {
    return scratch::data("rounding/" + name);
}

/// Thirteen equal circles in the unit square, the best packing known: 25 contacts, one rattler, h = 1.
const std::string radius_of_13 = "0.133993513499008491414263236065";

std::vector<std::string> square_13(const std::string& file) {
    return {"plateau", file,    "--columns=-,x,y",         "--radius", radius_of_13,
            "--walls", "fixed", "--box=-0.5:0.5,-0.5:0.5", "--json"};
}

} // namespace

BOOST_AUTO_TEST_SUITE(cli_rounding)

BOOST_AUTO_TEST_CASE(a_hyperstatic_packing_is_not_isostatic_by_rounding) {
    const auto answer = json_of(run(square_13(file_of("square13.txt"))), 1);
    BOOST_TEST(answer.at("isostatic").empty());
    BOOST_TEST(answer.at("widest").at("N") == 25);
    BOOST_TEST(answer.at("widest").at("rattlers") == 1);
    BOOST_TEST(answer.at("widest").at("counts").at("h") == 1);
    BOOST_TEST(answer.at("rounding").get<double>() < 1e-15);
    for (const char* name : {"torus3.xyz", "torus7.xyz", "torus8.xyz", "torus11.xyz"}) {
        BOOST_TEST_INFO_SCOPE(name);
        says(run({"plateau", file_of(name)}), 1, {"backbone isostatic, proved  at no threshold of ["});
    }
}

BOOST_AUTO_TEST_CASE(nor_is_it_in_a_mirror_elsewhere_or_of_another_size) {
    const scratch::Folder folder;
    const ForeignPacking read = [] {
        ForeignOptions options{.columns = {"-", "x", "y"}};
        options.size = SizeStatement{SizeMeaning::radius, "", std::stod(radius_of_13)};
        return read_foreign(file_of("square13.txt"), options);
    }();
    const std::string file = folder.at("p.txt");
    for (int k = 0; k < 24; ++k) {
        const double scale = 0.3 + 0.37 * k, shift = 0.1 * k * k, sign = k % 2 == 0 ? 1 : -1;
        const int digits = k % 3 == 0 ? 17 : k % 3 == 1 ? 12 : 8;
        std::string text = "x y r\n";
        for (std::size_t i = 0; i < read.packing.radius.size(); ++i) {
            text +=
                fmt::format("{:.{}g} {:.{}g} {:.{}g}\n", sign * scale * read.packing.q[2 * i] + shift, digits,
                            scale * read.packing.q[2 * i + 1] - shift, digits, scale * read.packing.radius[i], digits);
        }
        scratch::write(file, text);
        const std::string box = fmt::format("--box={:.17g}:{:.17g},{:.17g}:{:.17g}", shift - 0.5 * scale,
                                            shift + 0.5 * scale, -shift - 0.5 * scale, -shift + 0.5 * scale);
        const Outcome outcome = run({"plateau", file, "--walls", "fixed", box, "--json"});
        BOOST_TEST_INFO_SCOPE("placement " << k << ", " << digits << " digits");
        expect(outcome, 1);
        BOOST_TEST((digits == 8 || Answer::parse(outcome.out).at("widest").at("N") == 25)); // the next gap is 4.9e-5
    }
}

BOOST_AUTO_TEST_CASE(plateau_stays_within_its_thresholds) {
    says(run({"plateau", file_of("soft14.xyz"), "--cell", "diagonal", "--thresholds=-1e-9:1e-9"}), 1,
         {"backbone isostatic, proved  at no threshold of [-1e-09, 1e-09]"});
    says(run({"plateau", file_of("soft14.xyz"), "--cell", "diagonal", "--thresholds=-4e-3:-3.5e-3"}), 0,
         {"-0.0040000000000000001 <= threshold <= -0.0035"});
    // Below the rounding no list is known.
    expect(run({"plateau", file_of("torus11.xyz"), "--thresholds=-1e-17:1e-17"}), 2);
}

BOOST_AUTO_TEST_CASE(an_imported_state_says_what_its_file_cannot_tell) {
    const scratch::Folder folder;
    const std::string state = folder.at("s.json");
    for (const auto& [name, gaps] : {std::pair{"torus7.xyz", 8}, {"torus8.xyz", 1}, {"torus11.xyz", 1}}) {
        BOOST_TEST_INFO_SCOPE(name);
        const auto answer = json_of(run({"import", file_of(name), "--cell", "isotropic", "-o", state, "--json"}), 2);
        BOOST_TEST(answer.at("verdict") == "undecided");
        BOOST_TEST(static_cast<int>(answer.at("untold").at("gaps").size()) == gaps);
        BOOST_TEST(answer.at("untold").at("verdict_of_the_doubles") == "proved");
        says(run({"inspect", state}), 2,
             {"isostatic equilibrium    undecided: ", "jammed strictly          undecided: "});
        says(run({"certify", state, "-o", folder.at("c.json")}), 2,
             {"undecided      the claims are of the stored doubles"});
    }
    // A forged rounding is no way round it.
    std::string text = scratch::read(state);
    text.replace(text.find("\"rounding\":") + 11, 1, "-");
    scratch::write(state, text);
    expect(run({"inspect", state}), 65, {});
}

BOOST_AUTO_TEST_CASE(where_every_gap_is_told_the_answer_is_that_of_the_doubles) {
    const scratch::Folder folder;
    const std::string state = folder.at("s.json");
    const auto answer =
        json_of(run({"import", scratch::data("yade20.txt"), "--box", "0:6.797743980394215,0:6.804741233269178", "-o",
                     state, "--stress", "1,1", "--json"}));
    BOOST_TEST(answer.at("rounding").get<double>() > 1e-6); // six digits
    BOOST_TEST(answer.at("rounding").get<double>() < 1e-4);
    BOOST_TEST(answer.at("load").at("by_default").at("stress") == false);
    BOOST_TEST(answer.at("load").at("by_default").at("kind") == true);
    expect(run({"inspect", state}), 0);
}

BOOST_AUTO_TEST_CASE(sizes_that_are_wrong_by_a_factor_are_pointed_at) {
    const scratch::Folder folder;
    const std::string state = folder.at("s.json"), file = file_of("half_radii.xyz");
    const Outcome shown = run({"plateau", file});
    expect(shown, 2); // no range of thresholds, nothing is known of the list
    BOOST_TEST(contains(shown.out, "are the sizes wrong by a factor"), shown.out);
    expect(run({"import", file, "-o", state}), 65, {"of its radius: expected at most one", "--far"});
    BOOST_TEST(!std::filesystem::exists(state));
    says(run({"import", file, "-o", state, "--far"}), 0,
         {"more than a tenth: the vertex may not be that of the file", "(taken by default: --stress, --load)"});
    BOOST_TEST(contains(run({"plateau", file, "--diameter", "radius"}).out, "are the sizes wrong by a factor"));
    const Outcome twice = run({"plateau", scratch::data("rounding/soft14.xyz"), "--radius", "1"});
    BOOST_TEST(contains(twice.out, "are the sizes diameters, taken for radii"), twice.out);
}

BOOST_AUTO_TEST_SUITE_END()
