#include "timbre/datasets/species.h"

#include <array>
#include <map>
#include <numbers>
#include <span>
#include <string_view>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

using Eigen::Vector3d;
using Triple = std::array<double, 3>;

// A bone as the tables have it. One off the plane x = 0 stands for itself and its mirror
// image. The root comes first and names itself as parent.
struct Row {
  std::string_view name, parent;
  Triple head, tail;
  double head_radius, tail_radius;
  std::array<double, 6> turns;  // degrees about x, y, z: least, most of each
};

struct Species {
  std::string_view name;
  double blend;
  std::span<const Row> rows;
};

constexpr std::array<double, 6> kRigid = {};

// Signs of turns: x > 0 bows an upright bone, lifts a tail, takes a leg back; y > 0 turns
// to the left, takes a left arm back; z > 0 lifts a left arm, spreads a left leg.
// clang-format off: one bone a line
constexpr Row kPerson[] = {
    {"pelvis", "pelvis", {0, .98, 0}, {0, 1.08, 0}, .115, .105, kRigid},
    {"hip", "pelvis", {.03, .96, -.01}, {.085, .93, -.015}, .10, .095, kRigid},
    {"belly", "pelvis", {0, 1.08, .01}, {0, 1.22, .015}, .105, .11, {-10, 25, -20, 20, -12, 12}},
    {"chest", "belly", {0, 1.22, .015}, {0, 1.36, 0}, .115, .10, {-10, 15, -15, 15, -8, 8}},
    {"ribs", "chest", {.03, 1.27, .015}, {.075, 1.31, .015}, .10, .09, kRigid},
    {"clavicle", "chest", {.03, 1.40, 0}, {.16, 1.41, -.005}, .07, .06, {0, 0, 0, 0, -5, 12}},
    {"arm", "clavicle", {.19, 1.40, 0}, {.46, 1.33, 0}, .055, .043, {-20, 20, -60, 20, -55, 45}},
    {"forearm", "arm", {.46, 1.33, 0}, {.70, 1.27, .01}, .042, .034, {0, 0, -100, 0, 0, 0}},
    {"hand", "forearm", {.72, 1.265, .01}, {.84, 1.235, .015}, .046, .04, {0, 0, -25, 10, -30, 30}},
    {"neck", "chest", {0, 1.44, 0}, {0, 1.54, .01}, .055, .05, {-15, 20, -20, 20, -10, 10}},
    {"head", "neck", {0, 1.62, .015}, {0, 1.68, .02}, .095, .09, {-15, 15, -35, 35, -8, 8}},
    {"nose", "head", {0, 1.61, .10}, {0, 1.595, .125}, .03, .02, kRigid},
    {"thigh", "hip", {.10, .90, 0}, {.13, .50, .01}, .09, .058, {-75, 25, -10, 10, -3, 25}},
    {"shin", "thigh", {.13, .50, .01}, {.145, .10, -.02}, .056, .038, {0, 85, 0, 0, 0, 0}},
    {"foot", "shin", {.145, .06, -.03}, {.155, .035, .13}, .045, .03, {-15, 25, -10, 10, 0, 0}},
};

constexpr Row kChild[] = {
    {"pelvis", "pelvis", {0, .50, 0}, {0, .56, 0}, .095, .095, kRigid},
    {"hip", "pelvis", {.025, .48, -.01}, {.06, .465, -.01}, .085, .08, kRigid},
    {"belly", "pelvis", {0, .56, .015}, {0, .65, .02}, .10, .095, {-10, 25, -20, 20, -12, 12}},
    {"chest", "belly", {0, .65, .015}, {0, .72, 0}, .095, .085, {-10, 15, -15, 15, -8, 8}},
    {"clavicle", "chest", {.03, .75, 0}, {.09, .755, 0}, .06, .052, {0, 0, 0, 0, -5, 12}},
    {"arm", "clavicle", {.115, .75, 0}, {.255, .715, 0}, .047, .04, {-20, 20, -60, 20, -50, 45}},
    {"forearm", "arm", {.255, .715, 0}, {.375, .69, .005}, .039, .033, {0, 0, -95, 0, 0, 0}},
    {"hand", "forearm", {.385, .688, .005}, {.44, .675, .01}, .04, .033, {0, 0, -25, 10, -30, 30}},
    {"neck", "chest", {0, .79, 0}, {0, .82, .005}, .05, .05, {-12, 15, -20, 20, -10, 10}},
    {"head", "neck", {0, .92, .01}, {0, .96, .015}, .125, .12, {-12, 12, -30, 30, -8, 8}},
    {"nose", "head", {0, .905, .13}, {0, .90, .15}, .03, .025, kRigid},
    {"thigh", "hip", {.07, .45, 0}, {.09, .25, .01}, .075, .055, {-70, 25, -10, 10, -3, 25}},
    {"shin", "thigh", {.09, .25, .01}, {.10, .06, -.01}, .052, .042, {0, 80, 0, 0, 0, 0}},
    {"foot", "shin", {.10, .045, -.015}, {.11, .035, .075}, .045, .036, {-15, 20, -10, 10, 0, 0}},
};

constexpr Row kGorilla[] = {
    {"pelvis", "pelvis", {0, .72, -.02}, {0, .84, 0}, .16, .17, kRigid},
    {"hip", "pelvis", {.05, .68, -.02}, {.12, .64, -.02}, .13, .12, kRigid},
    {"belly", "pelvis", {0, .84, .02}, {0, 1.02, .04}, .19, .20, {-5, 25, -15, 15, -10, 10}},
    {"chest", "belly", {0, 1.02, .04}, {0, 1.22, .02}, .21, .19, {-5, 15, -12, 12, -8, 8}},
    {"clavicle", "chest", {.06, 1.28, .02}, {.27, 1.28, 0}, .14, .12, {0, 0, 0, 0, -5, 8}},
    {"arm", "clavicle", {.33, 1.27, 0}, {.66, 1.08, 0}, .105, .09, {-20, 20, -55, 20, -30, 60}},
    {"forearm", "arm", {.66, 1.08, 0}, {.98, .86, .02}, .09, .07, {-30, 0, -85, 0, 0, 0}},
    {"hand", "forearm", {1.0, .84, .02}, {1.12, .75, .04}, .075, .06, {-20, 0, -30, 10, -20, 20}},
    {"neck", "chest", {0, 1.34, .05}, {0, 1.42, .08}, .13, .12, {-10, 15, -20, 20, -8, 8}},
    {"head", "neck", {0, 1.5, .12}, {0, 1.58, .10}, .125, .10, {-15, 15, -25, 25, 0, 0}},
    {"muzzle", "head", {0, 1.44, .20}, {0, 1.43, .25}, .08, .07, kRigid},
    {"thigh", "hip", {.15, .60, 0}, {.20, .34, .05}, .13, .09, {-60, 25, -10, 10, 0, 30}},
    {"shin", "thigh", {.20, .34, .05}, {.21, .10, -.02}, .085, .062, {0, 70, 0, 0, 0, 0}},
    {"foot", "shin", {.21, .065, -.02}, {.24, .05, .18}, .065, .05, {-15, 25, -10, 10, 0, 0}},
};

constexpr Row kHorse[] = {
    {"barrel", "barrel", {0, 1.12, -.35}, {0, 1.12, .30}, .27, .29, kRigid},
    {"rump", "barrel", {0, 1.17, -.50}, {0, 1.12, -.62}, .25, .20, {-8, 8, -8, 8, 0, 0}},
    {"chest", "barrel", {0, 1.13, .42}, {0, 1.20, .55}, .25, .19, {-5, 5, -8, 8, 0, 0}},
    {"neck", "chest", {0, 1.28, .62}, {0, 1.62, .90}, .17, .125, {-15, 50, -25, 25, -5, 5}},
    {"nape", "neck", {0, 1.62, .90}, {0, 1.82, 1.02}, .12, .11, {-10, 25, -20, 20, 0, 0}},
    {"head", "nape", {0, 1.84, 1.06}, {0, 1.58, 1.38}, .11, .075, {-20, 15, -15, 15, 0, 0}},
    {"ear", "head", {.065, 1.93, 1.03}, {.125, 2.10, 1.02}, .065, .055, kRigid},
    {"dock", "rump", {0, 1.18, -.80}, {0, .95, -1.0}, .08, .08, {-10, 45, -30, 30, 0, 0}},
    {"tail", "dock", {0, .95, -1.0}, {0, .60, -1.06}, .08, .065, {-25, 25, -10, 10, -25, 25}},
    {"foreleg", "chest", {.17, 1.05, .45}, {.17, .66, .48}, .13, .085, {-45, 35, 0, 0, 0, 8}},
    {"cannon", "foreleg", {.17, .66, .48}, {.17, .26, .47}, .08, .062, {0, 75, 0, 0, 0, 0}},
    {"hoof", "cannon", {.17, .22, .48}, {.17, .06, .53}, .068, .085, {0, 40, 0, 0, 0, 0}},
    {"thigh", "rump", {.16, 1.05, -.55}, {.18, .68, -.48}, .17, .10, {-40, 30, 0, 0, 0, 8}},
    {"shank", "thigh", {.18, .68, -.48}, {.18, .42, -.68}, .095, .07, {0, 35, 0, 0, 0, 0}},
    {"pastern", "shank", {.18, .42, -.68}, {.18, .20, -.64}, .068, .063, {-35, 5, 0, 0, 0, 0}},
    {"hindhoof", "pastern", {.18, .18, -.62}, {.18, .06, -.57}, .068, .085, {0, 30, 0, 0, 0, 0}},
};

constexpr Row kDog[] = {
    {"trunk", "trunk", {0, .50, -.15}, {0, .50, .18}, .115, .14, kRigid},
    {"rump", "trunk", {0, .51, -.22}, {0, .50, -.30}, .11, .10, {-15, 10, -15, 15, 0, 0}},
    {"chest", "trunk", {0, .50, .24}, {0, .53, .30}, .13, .11, {-8, 8, -12, 12, 0, 0}},
    {"neck", "chest", {0, .58, .36}, {0, .70, .46}, .085, .075, {-15, 45, -30, 30, -8, 8}},
    {"head", "neck", {0, .74, .50}, {0, .73, .58}, .085, .08, {-25, 20, -25, 25, -12, 12}},
    {"snout", "head", {0, .71, .64}, {0, .69, .76}, .052, .042, kRigid},
    {"ear", "head", {.05, .81, .48}, {.08, .91, .46}, .04, .032, kRigid},
    {"tail", "rump", {0, .55, -.40}, {0, .64, -.52}, .038, .035, {-30, 30, -40, 40, 0, 0}},
    {"midtail", "tail", {0, .64, -.52}, {0, .75, -.60}, .035, .033, {-20, 30, -35, 35, 0, 0}},
    {"tailtip", "midtail", {0, .75, -.60}, {0, .86, -.63}, .036, .034, {-20, 30, -35, 35, 0, 0}},
    {"foreleg", "chest", {.085, .44, .24}, {.09, .27, .21}, .065, .045, {-45, 35, 0, 0, 0, 10}},
    {"forearm", "foreleg", {.09, .27, .21}, {.09, .07, .22}, .042, .034, {-45, 10, 0, 0, 0, 0}},
    {"paw", "forearm", {.09, .045, .23}, {.09, .038, .30}, .04, .036, {-10, 30, 0, 0, 0, 0}},
    {"thigh", "rump", {.085, .45, -.27}, {.095, .28, -.20}, .08, .05, {-40, 30, 0, 0, 0, 10}},
    {"shank", "thigh", {.095, .28, -.20}, {.095, .15, -.32}, .046, .036, {0, 40, 0, 0, 0, 0}},
    {"heel", "shank", {.095, .15, -.32}, {.095, .06, -.29}, .036, .034, {-30, 5, 0, 0, 0, 0}},
    {"hindpaw", "heel", {.095, .042, -.28}, {.095, .038, -.21}, .04, .036, {-10, 20, 0, 0, 0, 0}},
};

constexpr Row kGiraffe[] = {
    {"trunk", "trunk", {0, 1.85, -.30}, {0, 1.95, .30}, .29, .33, kRigid},
    {"rump", "trunk", {0, 1.80, -.42}, {0, 1.72, -.55}, .27, .21, {-6, 6, -8, 8, 0, 0}},
    {"chest", "trunk", {0, 2.0, .40}, {0, 2.1, .50}, .28, .21, {-5, 5, -8, 8, 0, 0}},
    {"neck", "chest", {0, 2.2, .58}, {0, 2.75, .85}, .19, .14, {-12, 30, -18, 18, -8, 8}},
    {"midneck", "neck", {0, 2.75, .85}, {0, 3.25, 1.05}, .135, .115, {-12, 25, -18, 18, -8, 8}},
    {"nape", "midneck", {0, 3.25, 1.05}, {0, 3.7, 1.2}, .115, .105, {-12, 25, -18, 18, -8, 8}},
    {"head", "nape", {0, 3.78, 1.25}, {0, 3.62, 1.62}, .12, .085, {-20, 20, -25, 25, 0, 0}},
    {"horn", "head", {.08, 3.88, 1.2}, {.15, 4.06, 1.18}, .075, .07, kRigid},
    {"dock", "rump", {0, 1.72, -.74}, {0, 1.35, -.86}, .085, .08, {-10, 40, -30, 30, 0, 0}},
    {"tail", "dock", {0, 1.35, -.86}, {0, 1.0, -.88}, .08, .085, {-20, 20, -10, 10, -25, 25}},
    {"foreleg", "chest", {.2, 1.75, .42}, {.2, 1.0, .42}, .15, .09, {-30, 30, 0, 0, 0, 8}},
    {"cannon", "foreleg", {.2, 1.0, .42}, {.2, .16, .42}, .085, .075, {0, 55, 0, 0, 0, 0}},
    {"hoof", "cannon", {.2, .10, .43}, {.2, .09, .50}, .09, .09, {0, 25, 0, 0, 0, 0}},
    {"thigh", "rump", {.18, 1.6, -.50}, {.2, 1.05, -.40}, .18, .11, {-30, 25, 0, 0, 0, 8}},
    {"shank", "thigh", {.2, 1.05, -.40}, {.2, .60, -.58}, .1, .08, {0, 30, 0, 0, 0, 0}},
    {"pastern", "shank", {.2, .60, -.58}, {.2, .16, -.52}, .08, .075, {-30, 5, 0, 0, 0, 0}},
    {"hindhoof", "pastern", {.2, .10, -.51}, {.2, .09, -.44}, .09, .09, {0, 20, 0, 0, 0, 0}},
};

constexpr Row kOstrich[] = {
    {"body", "body", {0, 1.0, -.25}, {0, 1.05, .20}, .23, .23, kRigid},
    {"tail", "body", {0, 1.09, -.45}, {0, 1.18, -.74}, .14, .08, {-20, 25, -20, 20, 0, 0}},
    {"neck", "body", {0, 1.15, .36}, {0, 1.45, .52}, .12, .075, {-15, 40, -25, 25, -8, 8}},
    {"midneck", "neck", {0, 1.45, .52}, {0, 1.75, .55}, .072, .066, {-25, 30, -20, 20, -12, 12}},
    {"nape", "midneck", {0, 1.75, .55}, {0, 2.0, .55}, .064, .06, {-25, 30, -20, 20, -12, 12}},
    {"head", "nape", {0, 2.05, .58}, {0, 2.05, .67}, .088, .075, {-25, 25, -30, 30, 0, 0}},
    {"beak", "head", {0, 2.03, .75}, {0, 2.0, .90}, .058, .05, kRigid},
    {"wing", "body", {.22, 1.15, .12}, {.55, 1.12, -.02}, .10, .08, {-15, 15, -15, 25, -35, 40}},
    {"wingtip", "wing", {.55, 1.12, -.02}, {.90, 1.05, -.20}, .075, .055, {0, 0, -10, 50, -25, 25}},
    {"thigh", "body", {.13, .88, -.02}, {.17, .66, .08}, .13, .085, {-35, 25, 0, 0, 0, 10}},
    {"shin", "thigh", {.17, .66, .08}, {.17, .34, -.08}, .075, .052, {-10, 40, 0, 0, 0, 0}},
    {"tarsus", "shin", {.17, .34, -.08}, {.17, .06, .02}, .052, .048, {-45, 10, 0, 0, 0, 0}},
    {"toes", "tarsus", {.17, .05, .05}, {.18, .045, .24}, .06, .05, {-15, 25, 0, 0, 0, 0}},
};

constexpr Row kLizard[] = {
    {"loin", "loin", {0, .24, .0}, {0, .24, -.30}, .125, .11, kRigid},
    {"chest", "loin", {0, .24, .02}, {0, .25, .28}, .125, .115, {-8, 8, -22, 22, 0, 0}},
    {"head", "chest", {0, .26, .42}, {0, .27, .50}, .09, .095, {-15, 10, -25, 25, 0, 0}},
    {"snout", "head", {0, .26, .60}, {0, .24, .76}, .078, .055, kRigid},
    {"tail", "loin", {0, .22, -.42}, {0, .18, -.68}, .10, .08, {-8, 12, -25, 25, 0, 0}},
    {"midtail", "tail", {0, .18, -.68}, {0, .14, -.95}, .08, .065, {-8, 12, -30, 30, 0, 0}},
    {"endtail", "midtail", {0, .14, -.95}, {0, .11, -1.22}, .065, .052, {-8, 12, -30, 30, 0, 0}},
    {"tailtip", "endtail", {0, .11, -1.22}, {0, .10, -1.48}, .052, .04, {-8, 12, -30, 30, 0, 0}},
    {"arm", "chest", {.09, .24, .26}, {.30, .26, .32}, .065, .05, {0, 0, -30, 30, -15, 15}},
    {"forearm", "arm", {.30, .26, .32}, {.38, .07, .42}, .047, .042, {-25, 25, 0, 0, -15, 35}},
    {"hand", "forearm", {.38, .055, .43}, {.47, .045, .52}, .045, .04, {0, 0, -20, 20, 0, 0}},
    {"thigh", "loin", {.08, .23, -.28}, {.32, .27, -.24}, .08, .06, {0, 0, -30, 30, -15, 15}},
    {"shin", "thigh", {.32, .27, -.24}, {.40, .08, -.36}, .052, .044, {-25, 25, 0, 0, -15, 35}},
    {"foot", "shin", {.40, .06, -.36}, {.51, .045, -.26}, .047, .042, {0, 0, -20, 20, 0, 0}},
};

constexpr Row kAnt[] = {
    {"thorax", "thorax", {0, .50, -.12}, {0, .50, .14}, .12, .14, kRigid},
    {"waist", "thorax", {0, .48, -.22}, {0, .48, -.28}, .075, .075, kRigid},
    {"abdomen", "waist", {0, .50, -.46}, {0, .46, -.74}, .18, .14, {-30, 30, -30, 30, 0, 0}},
    {"head", "thorax", {0, .50, .36}, {0, .48, .47}, .15, .13, {-15, 15, -20, 20, 0, 0}},
    {"mandible", "head", {.10, .44, .56}, {.12, .41, .72}, .06, .048, {0, 0, -15, 10, 0, 0}},
    {"scape", "head", {.10, .57, .46}, {.20, .82, .62}, .05, .045, {-25, 15, -15, 15, -20, 10}},
    {"feeler", "scape", {.20, .82, .62}, {.26, .78, .92}, .045, .042, {-30, 30, -15, 30, 0, 0}},
    {"coxa1", "thorax", {.13, .45, .13}, {.38, .68, .31}, .06, .052, {-15, 15, -35, 25, -15, 25}},
    {"tibia1", "coxa1", {.38, .68, .31}, {.62, .36, .49}, .052, .05, {-10, 10, -30, 30, -20, 40}},
    {"tarsus1", "tibia1", {.62, .36, .49}, {.76, .05, .61}, .05, .046, {0, 0, 0, 0, -15, 30}},
    {"coxa2", "thorax", {.14, .45, 0}, {.45, .70, -.02}, .06, .052, {-15, 15, -25, 25, -15, 25}},
    {"tibia2", "coxa2", {.45, .70, -.02}, {.74, .36, -.04}, .052, .05, {-10, 10, -30, 30, -20, 40}},
    {"tarsus2", "tibia2", {.74, .36, -.04}, {.90, .05, -.05}, .05, .046, {0, 0, 0, 0, -15, 30}},
    {"coxa3", "thorax", {.13, .45, -.13}, {.42, .74, -.37}, .06, .052, {-15, 15, -25, 35, -15, 25}},
    {"tibia3", "coxa3", {.42, .74, -.37}, {.68, .40, -.69}, .052, .05, {-10, 10, -30, 30, -20, 40}},
    {"tarsus3", "tibia3", {.68, .40, -.69}, {.86, .05, -.98}, .05, .046, {0, 0, 0, 0, -15, 30}},
};
// clang-format on

constexpr Species kSpecies[] = {
    {"person", 0.015, kPerson},   {"child", 0.012, kChild},   {"gorilla", 0.025, kGorilla},
    {"horse", 0.03, kHorse},      {"dog", 0.015, kDog},       {"giraffe", 0.03, kGiraffe},
    {"ostrich", 0.022, kOstrich}, {"lizard", 0.015, kLizard}, {"ant", 0.015, kAnt},
};

const Species& find(const std::string& name) {
  std::string known;
  for (const Species& species : kSpecies) {
    if (species.name == name) return species;
    known += (known.empty() ? "" : ", ") + std::string(species.name);
  }
  throw Error(ErrorKind::bad_request, "", "species", "no '" + name + "'; there are " + known);
}

Vector3d at(const Triple& xyz) { return {xyz[0], xyz[1], xyz[2]}; }

Vector3d reflected(const Vector3d& p) { return {-p.x(), p.y(), p.z()}; }

struct Limits {
  Vector3d least, most;
};

Limits limits_of(const Row& row) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const auto& t = row.turns;
  return {kDegree * Vector3d(t[0], t[2], t[4]), kDegree * Vector3d(t[1], t[3], t[5])};
}

// Turns about x mean the same on both sides; about y and z they change sign.
Bone mirror_image(Bone bone, int parent) {
  bone.name += ".right";
  bone.parent = parent;
  bone.head = reflected(bone.head);
  bone.tail = reflected(bone.tail);
  const Limits left = {bone.least, bone.most};
  for (const int axis : {1, 2}) {
    bone.least[axis] = -left.most[axis];
    bone.most[axis] = -left.least[axis];
  }
  return bone;
}

// Where bones of each row end up, and their images; the same where there is none.
struct Placed {
  const Row* row = nullptr;
  int left = -1, right = -1;
  double stretch = 1.0;
};

}  // namespace

std::vector<std::string> species_names() {
  std::vector<std::string> names;
  for (const Species& species : kSpecies) names.emplace_back(species.name);
  return names;
}

Skeleton make_skeleton(const std::string& name, double variation, Random& random) {
  const Species& species = find(name);
  Skeleton skeleton;
  skeleton.blend = species.blend;
  std::map<std::string_view, Placed> placed;
  for (const Row& row : species.rows) {
    const Placed parent = placed[row.parent];
    Placed& own = placed[row.name];
    own = {&row, static_cast<int>(skeleton.bones.size()), static_cast<int>(skeleton.bones.size()),
           1.0 + random.uniform(-variation, variation)};
    const double thickness = 1.0 + random.uniform(-variation, variation);
    Vector3d head = at(row.head);
    if (parent.row != nullptr) {
      head = skeleton.bones[static_cast<std::size_t>(parent.left)].head +
             parent.stretch * (head - at(parent.row->head));
    }
    const Vector3d tail = head + own.stretch * (at(row.tail) - at(row.head));
    const Limits limits = limits_of(row);
    skeleton.bones.push_back({std::string(row.name), parent.left, head, tail,
                              thickness * row.head_radius, thickness * row.tail_radius,
                              limits.least, limits.most});
    if (head.x() == 0.0 && tail.x() == 0.0) continue;
    own.right = own.left + 1;
    skeleton.bones.push_back(mirror_image(skeleton.bones.back(), parent.right));
  }
  return skeleton;
}

}  // namespace timbre
