(** What Coq's integers and lists are in OCaml. Nothing here is proved: whoever believes an extracted program believes this.

    All of Coq's kinds of numbers are integers of Zarith, however large; natural numbers are those that are not negative,
    and [positive] has those from 1. Constructors and matches are those of Coq's definitions. Functions that are not
    named here are extracted from their definitions. *)
From Coq Require Import ZArith.
From Coq Require Extraction.
From mathcomp Require Import all_ssreflect.

Extraction Language OCaml.
Extract Inductive bool => bool [ true false ].
Extract Inductive option => option [ Some None ].
Extract Inductive list => list [ "[]" "( :: )" ].
Extract Inductive prod => "( * )" [ "" ].
Extract Inductive comparison => int [ "0" "(-1)" "1" ].
Extract Inlined Constant andb => "(&&)".
Extract Inlined Constant orb => "(||)".

Extract Inductive nat => "Zarith.t" [ "Zarith.zero" "Zarith.succ" ]
  "(fun zero next k -> if Zarith.sign k = 0 then zero () else next (Zarith.pred k))".
Extract Inductive positive => "Zarith.t"
  [ "(fun p -> Zarith.succ (Zarith.shift_left p 1))" "(fun p -> Zarith.shift_left p 1)" "Zarith.one" ]
  "(fun odd even one p -> if Zarith.equal p Zarith.one then one () else
    if Zarith.is_odd p then odd (Zarith.shift_right p 1) else even (Zarith.shift_right p 1))".
Extract Inductive N => "Zarith.t" [ "Zarith.zero" "" ]
  "(fun zero positive k -> if Zarith.sign k = 0 then zero () else positive k)".
Extract Inductive Z => "Zarith.t" [ "Zarith.zero" "" "Zarith.neg" ]
  "(fun zero positive negative k -> match Zarith.sign k with 0 -> zero () | 1 -> positive k | _ -> negative (Zarith.neg k))".

Extract Inlined Constant Init.Nat.add => "Zarith.add".
Extract Inlined Constant Init.Nat.sub => "(fun a b -> Zarith.max Zarith.zero (Zarith.sub a b))".
Extract Inlined Constant eqn => "Zarith.equal".
Extract Inlined Constant double_rec => "(fun a -> Zarith.shift_left a 1)".
Extract Inlined Constant Pos.to_nat => "(fun p -> p)".
Extract Inlined Constant Pos.of_succ_nat => "Zarith.succ".
Extract Inlined Constant Pos.eqb => "Zarith.equal".
Extract Inlined Constant Pos.compare => "Zarith.compare".
Extract Inlined Constant Z.add => "Zarith.add".
Extract Inlined Constant Z.mul => "Zarith.mul".
Extract Inlined Constant Z.compare => "Zarith.compare".
