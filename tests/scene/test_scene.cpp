#include "scene/seed.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/scene/scene.hpp>

using namespace isostat;

namespace {

Scene parse_scene_text(const std::string& text) {
    return parse_scene(text, "s.toml", "/folder");
}

void refuses_scene(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_scene_text(text); }, words);
}

const std::string head = "[packing]\ndisks = 10\n"; // lines 1 and 2

std::string value_of(const Scene& scene, const std::string& section, const std::string& key) {
    const auto found =
        std::ranges::find_if(scene.settings, [&](const Setting& s) { return s.section == section && s.key == key; });
    return found == scene.settings.end() ? "absent" : found->value;
}

} // namespace

BOOST_AUTO_TEST_CASE(a_small_scene_gets_the_defaults_of_the_library) {
    const Scene scene = parse_scene_text(head);
    const PreparationOptions preparation;
    const RunOptions run;
    BOOST_TEST(scene.preparation.disks == 10);
    BOOST_TEST(scene.preparation.diameters.smallest == 1.0);
    BOOST_TEST(scene.preparation.diameters.largest == 2.0);
    BOOST_TEST(scene.preparation.stress == preparation.stress);
    BOOST_TEST(scene.preparation.softness == preparation.softness);
    BOOST_TEST(scene.preparation.max_steps == preparation.max_steps);
    BOOST_TEST((scene.run.rule == run.rule));
    BOOST_TEST(scene.run.max_arcs == run.max_arcs);
    BOOST_TEST(scene.run.max_strain == run.max_strain);
    BOOST_TEST(scene.run.step_fraction == run.step_fraction);
    BOOST_TEST(scene.pictures);
    BOOST_TEST(!scene.vtk);
    BOOST_TEST(scene.programme.empty());
    BOOST_TEST(value_of(scene, "run", "max_arcs") == "20000");
}

BOOST_AUTO_TEST_CASE(every_setting_arrives) {
    const Scene scene = parse_scene_text(R"(
[packing]
disks = 20
law = "lognormal"
diameter = 0.9
deviation = 0.1
diameters = [0.5, 3]
jitter = 1e-6
seed = 9
aspect = 2
[preparation]
loose_fraction = 0.5
softness = 1e-6
relaxation = 1e-5
max_steps = 1000
infinitesimal_weight = 1e-8
max_programmes = 7
[load]
kind = "true"
sigma1 = 2.5
[[programme]]
do = "up"
equilibria = 5
to = 1.5
name = "first"
[[programme]]
do = "to"
to = 1
[[programme]]
do = "down"
from = 3
equilibria = 2
[run]
rule = "least_index"
rule_seed = 4
max_arcs = 11
max_strain = 0.25
step_fraction = 0.5
certify = "arcs"
ties = "choose"
max_choices = 3
ties_seed = 9
[output]
states_every = 10
checkpoint_seconds = 2.5
pictures = false
vtk = true
)");
    BOOST_TEST((scene.preparation.diameters.kind == RadiiLaw::lognormal));
    BOOST_TEST(scene.preparation.diameters.diameter == 0.9);
    BOOST_TEST(scene.preparation.diameters.deviation == 0.1);
    BOOST_TEST(scene.preparation.diameters.largest == 3.0);
    BOOST_TEST(scene.preparation.jitter == 1e-6);
    BOOST_TEST(scene.preparation.seed == 9U);
    BOOST_TEST(scene.preparation.aspect == 2.0);
    BOOST_TEST(scene.preparation.loose_fraction == 0.5);
    BOOST_TEST(scene.preparation.softness == 1e-6);
    BOOST_TEST(scene.preparation.relaxation == 1e-5);
    BOOST_TEST(scene.preparation.max_steps == 1000);
    BOOST_TEST(scene.preparation.infinitesimal_weight == 1e-8);
    BOOST_TEST(scene.preparation.max_programmes == 7);
    BOOST_TEST((scene.preparation.load == LoadKind::true_stress));
    BOOST_TEST((scene.load_kind == LoadKind::true_stress));
    BOOST_TEST(scene.preparation.stress == 2.5);
    BOOST_REQUIRE(scene.programme.size() == 3U);
    BOOST_TEST((scene.programme[0].action == Action::up));
    BOOST_TEST(*scene.programme[0].equilibria == 5);
    BOOST_TEST(*scene.programme[0].to == 1.5);
    BOOST_TEST(scene.programme[0].name == "first");
    BOOST_TEST((scene.programme[1].action == Action::to));
    BOOST_TEST(scene.programme[1].name == "to sigma2/sigma1 = 1");
    BOOST_TEST(*scene.programme[2].from == 3);
    BOOST_TEST((needed_equilibria(scene) == std::vector<int>{3}));
    BOOST_TEST((scene.run.rule == OpeningRule::least_index));
    BOOST_TEST(scene.run.rule_seed == 4U);
    BOOST_TEST(scene.run.max_arcs == 11);
    BOOST_TEST(scene.run.max_strain == 0.25);
    BOOST_TEST(scene.run.step_fraction == 0.5);
    BOOST_TEST((scene.run.certify == CertifyLevel::arcs));
    BOOST_TEST(scene.states_every == 10);
    BOOST_TEST(scene.checkpoint_seconds == 2.5);
    BOOST_TEST(!scene.pictures);
    BOOST_TEST(scene.vtk);
    // Nothing of this scene is a default: a key that was read but not recorded would be missing here.
    BOOST_TEST((scene.run.ties == TiePolicy::choose));
    BOOST_TEST(scene.run.max_choices == 3);
    BOOST_TEST(scene.run.ties_seed == 9U);
    BOOST_TEST(scene.settings.size() == 40U);
    for (const Setting& setting : scene.settings) {
        BOOST_TEST((setting.line > 0 || setting.key == "name"), setting.section << "." << setting.key);
    }
}

BOOST_AUTO_TEST_CASE(spheres_take_the_place_of_disks) {
    const std::string spheres = "[packing]\nspheres = 10\n";
    const Scene scene = parse_scene_text(spheres);
    BOOST_TEST(scene.preparation.dimension == 3);
    BOOST_TEST(scene.preparation.disks == 10);
    BOOST_TEST(value_of(scene, "packing", "spheres") == "10");
    BOOST_TEST(value_of(scene, "preparation", "loose_fraction") == "0.4");
    BOOST_TEST(parse_scene_text(head).preparation.dimension == 2);
    BOOST_TEST(value_of(parse_scene_text(head), "preparation", "loose_fraction") == "0.6");
    BOOST_TEST(
        (parse_scene_text(spheres + "law = \"bidisperse\"\n").preparation.diameters.kind == RadiiLaw::bidisperse));
    BOOST_TEST(parse_scene_text("[packing]\nradii = [1, 2]\n").preparation.dimension == 2);
    BOOST_TEST(parse_scene_text("[packing]\nradii = [1, 2]\ndimension = 3\n").preparation.dimension == 3);
    refuses_scene("[packing]\nradii = [1, 2]\ndimension = 4\n", {"s.toml:3:", "dimension", "4"});
    refuses_scene(spheres + "dimension = 3\n", {"s.toml:3:", "dimension", "radii", "spheres"});
    refuses_scene(spheres + "disks = 3\n", {"s.toml:2:", "'disks' and 'spheres'"});
    refuses_scene("[packing]\nradii = [1]\nlaw = \"equal\"\n",
                  {"s.toml:3:", "'law'", "'disks' or 'spheres'", "'radii'"});
    const auto kind = [&](const char* word) {
        return parse_scene_text(spheres + "[cell]\nkind = \"" + word + "\"\n").preparation.cell;
    };
    BOOST_TEST((kind("orthorhombic") == PreparedCell::rectangular));
    BOOST_TEST((kind("triclinic") == PreparedCell::tilted));
    BOOST_TEST((kind("isotropic") == PreparedCell::isotropic));
    refuses_scene(spheres + "[cell]\nkind = \"tilted\"\n", {"s.toml:4:", "tilted", "triclinic"});
    const Scene sheared = parse_scene_text(spheres + "[cell]\nkind = \"triclinic\"\n[load]\nloaded = \"xz\"\n");
    BOOST_TEST(sheared.preparation.loaded_axis.value() == 4);
    BOOST_TEST(parse_scene_text(spheres + "[load]\nloaded = \"x\"\n").preparation.loaded_axis.value() == 0);
    refuses_scene(spheres + "[load]\nloaded = \"xz\"\n", {"s.toml:4:", "no tilt moves", "triclinic"});
    refuses_scene(spheres + "[load]\nloaded = \"tilt\"\n", {"s.toml:4:", "loaded", "xz"});
    refuses_scene(head + "[load]\nloaded = \"z\"\n", {"s.toml:4:", "loaded", "tilt"});
    const auto path_of = [&](const std::string& load) {
        return parse_scene_text(spheres + "[load]\n" + load + "\n").preparation.path;
    };
    BOOST_TEST((path_of("loaded = \"constant_mean\"") == StressRates{-1, -1, 2}));
    BOOST_TEST((path_of("loaded = \"extension\"") == StressRates{0, 0, -1}));
    BOOST_TEST((path_of("direction = [1, 1.5, 0]") == StressRates{1, 1.5, 0}));
    for (const auto& [load, word] : {std::pair{"direction = [0, 0, 0]", "all numbers are 0"},
                                     {"direction = [1, 2]", "2 numbers"},
                                     {"direction = [1, 2, nan]", "finite"},
                                     {"direction = [1, 2, 0, 1, 0, 0]", "the tilt xy, which does not move"},
                                     {"loaded = \"z\"\ndirection = [1, 0, 0]", "exclude each other"}}) {
        refuses_scene(spheres + "[load]\n" + load + "\n", {"s.toml:", "direction", word});
    }
    refuses_scene(spheres + "[load]\nloaded = \"constant_mean\"\n[run]\ncertify = \"arcs\"\n",
                  {"certify", "arcs", "several stresses", "states"});
    refuses_scene(head + "[load]\ndirection = [1, -1]\n", {"s.toml:4:", "disks: expected spheres"});
    refuses_scene("[packing]\nspheres = 8193\n[cell]\n", {"s.toml:3:", "8193 spheres", "at most 8192"});
}

BOOST_AUTO_TEST_CASE(a_table_of_the_cell_takes_the_walls_away) {
    BOOST_TEST((parse_scene_text(head).preparation.cell == PreparedCell::none));
    BOOST_TEST((parse_scene_text(head + "[cell]\n").preparation.cell == PreparedCell::rectangular));
    const Scene tilted = parse_scene_text(head + "[cell]\nkind = \"tilted\"\n");
    BOOST_TEST((tilted.preparation.cell == PreparedCell::tilted));
    BOOST_TEST(value_of(tilted, "cell", "kind") == "\"tilted\"");
    BOOST_TEST((parse_scene_text(head + "[cell]\nkind = \"isotropic\"\n").preparation.cell == PreparedCell::isotropic));
    refuses_scene(head + "[cell]\nkind = \"isotropic\"\n[[programme]]\ndo = \"up\"\nequilibria = 1\n",
                  {"isotropic", "[[programme]]", "no contact ever opens"});
    refuses_scene(head + "[cell]\nkind = \"cubic\"\n", {"s.toml:4:", "kind", "cubic", "rectangular"});
    refuses_scene(head + "[cell]\nwalls = 2\n", {"s.toml:4:", "walls"});
    refuses_scene("[packing]\nfile = \"v.txt\"\n[cell]\n", {"s.toml:3:", "[cell] is of a preparation"});
    refuses_scene("[packing]\ndisks = 8193\n[cell]\n", {"s.toml:3:", "8193 disks", "at most 8192"});
    BOOST_TEST(
        (parse_scene_text(head + "[cell]\n[load]\nkind = \"true\"\n").preparation.load == LoadKind::true_stress));
    refuses_scene(head + "[cell]\nkind = \"tilted\"\n[load]\nkind = \"true\"\n",
                  {"s.toml:6:", "kind", "tilt", "nominal"});
    BOOST_TEST((parse_scene_text(head + "[cell]\n[run]\nties = \"choose\"\n").run.ties == TiePolicy::choose));
}

BOOST_AUTO_TEST_CASE(a_law_has_its_own_keys_and_no_others) {
    const DiameterLaw mixture =
        parse_scene_text(head + "law = \"bidisperse\"\nratio = 2\nfraction = 0.25\n").preparation.diameters;
    BOOST_TEST((mixture.kind == RadiiLaw::bidisperse));
    BOOST_TEST(mixture.ratio == 2.0);
    BOOST_TEST(mixture.fraction == 0.25);
    const Scene cut = parse_scene_text(head + "law = \"normal\"\ndiameter = 3\n");
    BOOST_TEST(value_of(cut, "packing", "law") == "\"normal\"");
    BOOST_TEST(value_of(cut, "packing", "diameters") == "[1.5, 6.0]");
    BOOST_TEST(value_of(cut, "packing", "deviation") == "0.2");
    BOOST_TEST(value_of(cut, "packing", "ratio") == "absent");
    refuses_scene(head + "law = \"poisson\"\n", {"s.toml:3:", "law", "poisson", "\"bidisperse\""});
    refuses_scene(head + "exponent = 2\n", {"s.toml:3:", "'exponent'", "law = \"power\"", "\"uniform\""});
    refuses_scene(head + "law = \"equal\"\ndiameters = [1, 2]\n", {"s.toml:4:", "'diameters'", "\"equal\""});
    refuses_scene(head + "law = \"bidisperse\"\nratio = 0.5\n", {"s.toml:4:", "ratio", "0.5", "from 1"});
    refuses_scene(head + "law = \"normal\"\ndiameters = [2, 3]\n", {"s.toml:3:", "diameter is 1", "cut"});
    refuses_scene("[packing]\nradii = [1]\nlaw = \"equal\"\n", {"s.toml:3:", "'law'", "'disks'", "'radii'"});
    refuses_scene("[packing]\nfile = \"v\"\nratio = 2\n", {"s.toml:3:", "'ratio'", "'file'"});
}

BOOST_FIXTURE_TEST_CASE(radii_come_from_a_list_or_a_file, scratch::InFolder) {
    scratch::write(folder / "r.txt", "# radii\n1\n\n0x2\n");
    BOOST_TEST((parse_scene_text("[packing]\nradii = [1, 2.5]\n").preparation.radii == std::vector<double>{1, 2.5}));
    const std::string text = "[packing]\nradii_file = \"r.txt\"\n";
    expect_bad_input([&] { (void)parse_scene(text, "s.toml", folder.path()); },
                     {"r.txt:4:", "radius of disk 1", "'0x2'"});
    scratch::write(folder / "r.txt", "# radii\n1\n\n2\n");
    BOOST_TEST((parse_scene(text, "s.toml", folder.path()).preparation.radii == std::vector<double>{1, 2}));
    scratch::write(folder / "r.txt", "1\n-2\n");
    expect_bad_input([&] { (void)parse_scene(text, "s.toml", folder.path()); }, {"r.txt:2:", "'-2'", "positive"});
    scratch::write(folder / "r.txt", "1\nnan\n");
    expect_bad_input([&] { (void)parse_scene(text, "s.toml", folder.path()); }, {"r.txt:2:", "'nan'", "finite"});
    refuses_scene("[packing]\nradii = [1, -2]\n", {"s.toml:2:", "radii[1]", "-2", "positive"});
    refuses_scene("[packing]\nradii = [1, nan]\n", {"s.toml:2:", "radii[1]", "nan", "finite"});
    refuses_scene("[packing]\nradii = []\n", {"s.toml:2:", "radii", "at least one"});
}

BOOST_AUTO_TEST_CASE(unknown_keys_and_sections_are_named_with_their_line) {
    refuses_scene(head + "dsks = 3\n", {"s.toml:3:", "unknown key 'dsks'", "[packing]", "disks, "});
    refuses_scene(head + "[ouput]\n", {"s.toml:3:", "'ouput'", "[output]"});
    refuses_scene(head + "[run]\n\nrules = \"random\"\n", {"s.toml:5:", "unknown key 'rules'", "[run]"});
    refuses_scene(head + "[[programme]]\ndo = \"up\"\nequilibria = 1\nsteps = 3\n",
                  {"s.toml:6:", "unknown key 'steps'", "[[programme]]"});
    refuses_scene("seed = 1\n" + head, {"s.toml:1:", "'seed'"});
}

BOOST_AUTO_TEST_CASE(bad_values_are_named_with_their_line) {
    refuses_scene("[packing]\ndisks = 0\n", {"s.toml:2:", "disks", "is 0", "from 1"});
    refuses_scene("[packing]\ndisks = 2.5\n", {"s.toml:2:", "disks", "2.5", "integer"});
    refuses_scene("[packing]\ndisks = \"many\"\n", {"s.toml:2:", "disks", "many", "integer"});
    refuses_scene(head + "diameters = [2, 1]\n", {"s.toml:3:", "diameters", "smallest <= largest"});
    refuses_scene(head + "diameters = [0, 1]\n", {"s.toml:3:", "diameters", "0 < smallest"});
    refuses_scene(head + "diameters = [1]\n", {"s.toml:3:", "diameters"});
    refuses_scene(head + "diameters = 1\n", {"s.toml:3:", "diameters", "array"});
    refuses_scene(head + "jitter = 0.2\n", {"s.toml:3:", "jitter", "0.2", "1e-14 to 0.1"});
    refuses_scene(head + "jitter = 1e-15\n", {"s.toml:3:", "jitter", "1e-15", "1e-14 to 0.1"});
    refuses_scene(head + "seed = -1\n", {"s.toml:3:", "seed", "-1"});
    refuses_scene(head + "aspect = nan\n", {"s.toml:3:", "aspect", "nan", "finite"});
    refuses_scene(head + "aspect = inf\n", {"s.toml:3:", "aspect", "inf", "finite"});
    refuses_scene(head + "[load]\nkind = \"dead\"\n", {"s.toml:4:", "kind", "dead", "nominal"});
    refuses_scene(head + "[load]\nsigma1 = 0\n", {"s.toml:4:", "sigma1", "positive"});
    refuses_scene(head + "[run]\nrule = \"best\"\n", {"s.toml:4:", "rule", "best", "most_negative"});
    refuses_scene(head + "[run]\nties = \"break\"\n", {"s.toml:4:", "ties", "break", "choose"});
    refuses_scene(head + "[run]\nmax_arcs = 0\n", {"s.toml:4:", "max_arcs", "0"});
    refuses_scene(head + "[run]\nstep_fraction = -0.1\n", {"s.toml:4:", "step_fraction", "-0.1"});
    refuses_scene(head + "[output]\npictures = 1\n", {"s.toml:4:", "pictures", "true or false"});
    refuses_scene(head + "[output\n", {"s.toml:3:", "TOML"});
    refuses_scene(head + "disks = 11\n", {"s.toml:3:", "TOML"});
    refuses_scene("packing = 3\n", {"s.toml:1:", "packing", "table"});
    refuses_scene(head + "[programme]\ndo = \"up\"\n", {"s.toml:3:", "[[programme]]"});
}

BOOST_AUTO_TEST_CASE(words_that_scenes_no_longer_have_are_refused_with_what_to_write_instead) {
    refuses_scene(head + "[run]\ncertify = \"plain\"\n", {"s.toml:4:", "certify", "plain", "\"decisions\""});
    refuses_scene(head + "[run]\nties = \"perturb\"\n",
                  {"s.toml:4:", "ties", "perturb", "\"choose\"", "max_choices = 0"});
    refuses_scene(head + "[run]\nrule = \"steepest\"\n", {"s.toml:4:", "rule", "steepest", "\"most_negative\""});
    refuses_scene(head + "[run]\nties = \"class\"\n", {"s.toml:4:", "ties", "class", "\"choose\""});
}

BOOST_AUTO_TEST_CASE(settings_that_exclude_each_other_are_refused) {
    refuses_scene("[run]\nmax_arcs = 3\n", {"s.toml", "[packing]"});
    refuses_scene("[packing]\nseed = 3\n", {"s.toml:1:", "file, disks, radii or radii_file"});
    refuses_scene(head + "file = \"v.txt\"\n", {"s.toml:2:", "'file' and 'disks'", "exclude each other"});
    refuses_scene(head + "radii = [1]\n", {"s.toml:3:", "'disks' and 'radii'"});
    refuses_scene("[packing]\nradii = [1]\ndiameters = [1, 2]\n", {"s.toml:3:", "diameters", "radii"});
    refuses_scene("[packing]\nfile = \"v.txt\"\nseed = 2\n", {"s.toml:3:", "seed", "file"});
    refuses_scene("[packing]\nfile = \"v.txt\"\njitter = 1e-9\n", {"s.toml:3:", "jitter", "file"});
    refuses_scene("[packing]\nfile = \"v.txt\"\n[preparation]\nsoftness = 1e-6\n", {"s.toml:3:", "[preparation]"});
    refuses_scene("[packing]\nfile = \"v.txt\"\n[load]\nsigma1 = 2\n", {"s.toml:4:", "sigma1"});
    refuses_scene(head + "[run]\nties_seed = 2\n", {"s.toml:4:", "ties_seed", "choose"});
    refuses_scene(head + "[run]\nmax_choices = 0\n", {"s.toml:4:", "max_choices", "choose"});
    refuses_scene(head + "[run]\nties = \"choose\"\nmax_choices = -1\n", {"s.toml:5:", "max_choices", "-1"});
    refuses_scene(head + "[load]\ninfinitesimal_seed = 2\n", {"s.toml:4:", "infinitesimal_seed"});
}

BOOST_AUTO_TEST_CASE(a_start_file_is_relative_to_the_scene) {
    const Scene scene = parse_scene_text("[packing]\nfile = \"v.txt\"\n[load]\ninfinitesimal_seed = 3\n");
    BOOST_TEST(scene.start.string() == "/folder/v.txt");
    BOOST_TEST(*scene.infinitesimal_seed == 3U);
    BOOST_TEST(!scene.load_kind.has_value());
}

BOOST_AUTO_TEST_CASE(a_byte_order_mark_is_no_part_of_a_scene) {
    const std::string text = "packing = { radii = [1.25, 2.5], seed = 3 }\n";
    const Scene plain = parse_scene(text, "FILE", ""), marked = parse_scene("\xEF\xBB\xBF" + text, "FILE", "");
    BOOST_TEST((marked.preparation.radii == plain.preparation.radii));
    const std::string other = with_seed("\xEF\xBB\xBF" + text, 12, "FILE", "");
    BOOST_TEST(other == "packing = { radii = [1.25, 2.5], seed = 12 }\n");
}

BOOST_AUTO_TEST_CASE(names_with_too_many_parts_are_refused) {
    const auto dotted = [](int parts) {
        std::string text = "a";
        for (int k = 1; k < parts; ++k) {
            text += k % 3 == 0 ? " . \"b.c\"" : k % 3 == 1 ? ".a" : ". 'd'";
        }
        return text;
    };
    for (const std::string& text :
         {dotted(100'000) + " = 1\n", "[" + dotted(65) + "]\n", "x = {" + dotted(65) + " = 1}\n"}) {
        expect_bad_input([&] { (void)parse_scene("# first\n" + text, "FILE", ""); }, {"FILE:2:", "64 parts"});
    }
    // Points of numbers, of text and of comments are none of a name.
    std::string numbers = "radii = [";
    for (int k = 0; k < 100; ++k) {
        numbers += "1.5, ";
    }
    std::string points(200, '.');
    const std::string text = "[packing] # " + points + "\n" + numbers +
                             "]\n[[programme]]\ndo = \"up\"\nequilibria = 1\nname = \"\"\"" + points + "\\\"" + points +
                             "\"\"\"\"\n";
    BOOST_TEST(parse_scene(text, "FILE", "").preparation.radii.size() == 100U);
}

BOOST_AUTO_TEST_CASE(sizes_beyond_the_range_of_the_arithmetic_are_refused) {
    expect_bad_input([] { (void)parse_scene("[packing]\ndisks = 8\ndiameters = [1e-200, 1e200]\n", "FILE", ""); },
                     {"FILE:3:", "diameters", "1e+140"});
    expect_bad_input([] { (void)parse_scene("[packing]\nradii = [1.0, 1e-200]\n", "FILE", ""); },
                     {"FILE:2:", "radii[1]", "1e-140"});
}
