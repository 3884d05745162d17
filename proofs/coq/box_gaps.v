(** Statement K9 (../checker.md) for a box: grains that no listed contact joins are apart by a stated gap.

    Disks are sorted by x; each is compared with those that follow, until one is too far. The coordinates are integers
    within [error] of the true ones. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify ring.
From Isostat Require Import contact_certificate integers_in_a_field box.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

(** Two names of one contact. *)
Definition same (c d : contact) : bool :=
  match c, d with
  | Disks i j, Disks k l => (i == k) && (j == l) || (i == l) && (j == k)
  | Lower i a, Lower k b | Upper i a, Upper k b => (i == k) && (a == b)
  | _, _ => false
  end.
Definition listed (contacts : seq contact) (c : contact) : bool := has (same c) contacts.

Section Sweep.
Variables (n : nat) (contacts : seq contact) (radius x : nat -> Z) (error gap widest : Z).
Local Open Scope Z_scope.

Definition least_distance (i j a : nat) : Z := Z.max 0 (Z.abs (x (i.*2 + a)%N - x (j.*2 + a)%N) - 2 * error).
Definition far (c : contact) : bool :=
  match c with
  | Disks i j => let d := radius i + radius j + gap in
      d * d <=? least_distance i j 0 * least_distance i j 0 + least_distance i j 1 * least_distance i j 1
  | Lower i a => radius i + gap + error <=? x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap + 2 * error <=? x (n.*2 + a)%N
  end.
(** "if" spares the second question where the first is answered; a disjunction would compute both. *)
Definition settled (c : contact) : bool := if far c then true else listed contacts c.

Definition left_of (i j : nat) : bool := x (i.*2) <=? x (j.*2).
Definition out_of_reach (i j : nat) : bool := 2 * widest + gap + 2 * error <=? x (j.*2) - x (i.*2).
Fixpoint settled_until_far (i : nat) (others : seq nat) : bool :=
  if others is j :: rest then
    if out_of_reach i j then true else settled (Disks i j) && settled_until_far i rest
  else true.
Fixpoint sweep (order : seq nat) : bool :=
  if order is i :: rest then settled_until_far i rest && sweep rest else true.

Definition walls_settled (i : nat) : bool :=
  [&& settled (Lower i 0), settled (Lower i 1), settled (Upper i 0) & settled (Upper i 1)].
Definition gaps_check : bool :=
  [&& 0 <=? gap, 0 <=? error, all (fun i => (0 <=? radius i) && (radius i <=? widest)) (iota 0 n),
    sweep (sort left_of (iota 0 n)) & all walls_settled (iota 0 n)].

Let settled_or_far (i j : nat) : Prop := settled (Disks i j) \/ out_of_reach i j.

Let left_of_transitive : transitive left_of.
Proof. by move=> j i k; rewrite /left_of; lia. Qed.
Let left_of_total : total left_of.
Proof. by move=> i j; rewrite /left_of; lia. Qed.

Let until_far i others : path left_of i others -> settled_until_far i others ->
  forall j, j \in others -> settled_or_far i j.
Proof.
elim: others => //= k rest IH /andP[ik sorted] check j.
have /allP min := order_path_min left_of_transitive sorted.
case: ifP check => [out _|_ /andP[ok rest_ok]].
  rewrite inE => /orP[/eqP->|/min kj]; first by right.
  by right; move: out kj; rewrite /out_of_reach /left_of; lia.
rewrite inE => /orP[/eqP->|jr]; first by left.
apply: IH => //; case: (rest) sorted => //= m s /andP[km ->]; rewrite andbT.
exact: left_of_transitive ik km.
Qed.

Lemma sweep_covers order : sorted left_of order -> sweep order -> forall i j, i \in order -> j \in order -> i != j ->
  settled_or_far i j \/ settled_or_far j i.
Proof.
elim: order => //= k rest IH sorted /andP[first others] i j; rewrite !inE.
have rest_sorted : path.sorted left_of rest by apply: path_sorted sorted.
case/orP=> [/eqP->|ir] /orP[/eqP->|jr]; rewrite ?eqxx // => ne.
- by left; apply: until_far jr.
- by right; apply: until_far ir.
- exact: IH.
Qed.
End Sweep.

Local Open Scope ring_scope.

(** Grains are apart: their distance exceeds that of contact by [gap] at least. *)
Definition apart (F : realFieldType) (n : nat) (radius x : nat -> F) (gap : F) (c : contact) : Prop :=
  match c with
  | Disks i j => (radius i + radius j + gap) ^+ 2
      <= (x (i.*2)%N - x (j.*2)%N) ^+ 2 + (x (i.*2 + 1)%N - x (j.*2 + 1)%N) ^+ 2
  | Lower i a => radius i + gap <= x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap <= x (n.*2 + a)%N
  end.

Section Apart.
Variables (F : realFieldType) (n : nat) (contacts : seq contact) (radius x : nat -> Z) (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).

(** A square is at least that of any smaller size. *)
Let square_above (t d : F) : 0 <= t -> t <= `|d| -> t ^+ 2 <= d ^+ 2.
Proof. by move=> t0 td; rewrite -(real_normK (num_real d)) ler_pexpn2r ?nnegrE. Qed.

Let distance i j a : real (least_distance x error i j a) ^+ 2 <= (y (i.*2 + a)%N - y (j.*2 + a)%N) ^+ 2.
Proof.
apply: square_above; first by rewrite -(real_zero F) real_le /least_distance; lia.
rewrite /least_distance; set m := Z.sub _ _; case: (Z.max_spec Z0 m) => [[_ ->]|[_ ->]]; last by rewrite real_zero normr_ge0.
set u := (i.*2 + a)%N; set v := (j.*2 + a)%N.
rewrite /m real_minus -real_abs ler_subl_addr rmorphB /= (_ : real (Z.mul 2 error) = real error + real error); last first.
  by rewrite -real_plus; congr real; lia.
have -> : real (x u) - real (x v) = (y u - y v) - ((y u - real (x u)) - (y v - real (x v))) by ring.
by apply: le_trans (ler_norm_sub _ _) _; rewrite ler_add2l; apply: le_trans (ler_norm_sub _ _) _; apply: ler_add.
Qed.

Let below k : y k <= real (x k) + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)). Qed.
Let above k : real (x k) <= y k + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)) // distrC. Qed.

Lemma far_is_apart c : far n radius x error gap c -> apart n R y (real gap) c.
Proof.
case: c => [i j|i a|i a]; rewrite /far /apart -(real_le F) !(real_plus, real_times) => enough.
- rewrite -!expr2 in enough; apply: le_trans enough _.
  by have := distance i j 0; have := distance i j 1; rewrite !addn0 => d1 d0; apply: ler_add.
- by rewrite -(ler_add2r (real error)); apply: le_trans enough (above _).
rewrite -(ler_add2r (real error)); apply: le_trans (above _); apply: le_trans enough.
rewrite (_ : real (Zpos 2) = 1 + 1); last by rewrite -[Zpos 2]/(Z.add 1 1) real_plus rmorph1.
have -> : real (x (i.*2 + a)%N) + real (radius i) + real gap + (1 + 1) * real error
   = (real (x (i.*2 + a)%N) + real error) + (R i + real gap + real error) :> F by rewrite /R; ring.
have -> : y (i.*2 + a)%N + R i + real gap + real error = y (i.*2 + a)%N + (R i + real gap + real error) by ring.
by rewrite ler_add2r below.
Qed.

Lemma apart_of_disks i j : apart n R y (real gap) (Disks i j) -> apart n R y (real gap) (Disks j i).
Proof. by rewrite /apart [R j + _]addrC -[X in X ^+ 2 + _]opprB -[X in _ + X ^+ 2]opprB !sqrrN. Qed.

Lemma out_of_reach_is_apart i j : 0 <= gap -> 0 <= radius i -> 0 <= radius j -> radius i <= widest -> radius j <= widest ->
  out_of_reach x error gap widest i j -> apart n R y (real gap) (Disks i j).
Proof.
move=> g0 Ri0 Rj0 Ri Rj out; apply: far_is_apart; rewrite /far /least_distance !addn0.
apply/Z.leb_le; move: out; rewrite /out_of_reach; set d := Z.add (Z.add _ _) gap.
set s := Z.max _ _; set t := Z.max 0 _ => out.
have ds : Z.le d s by rewrite /d /s; lia.
have d0 : Z.le 0 d by rewrite /d; lia.
by nia.
Qed.

Theorem other_grains_are_apart c : gaps_check n contacts radius x error gap widest -> well_formed n c ->
  ~~ listed contacts c -> apart n R y (real gap) c.
Proof.
case/and5P=> g0 _ /allP sizes swept /allP walls formed.
have of_settled d : settled n contacts radius x error gap d -> ~~ listed contacts d -> apart n R y (real gap) d.
  by rewrite /settled; case: ifP => [/far_is_apart|_ ->].
have in_n i : (i < n)%N -> i \in iota 0 n by rewrite mem_iota.
case: c formed => [i j|i a|i a] /=; last 2 first.
- case/andP=> /in_n/walls/and4P[l0 l1 _ _]; case: a => [|[|a]] // _; [exact: of_settled l0|exact: of_settled l1].
- case/andP=> /in_n/walls/and4P[_ _ u0 u1]; case: a => [|[|a]] // _; [exact: of_settled u0|exact: of_settled u1].
case/and3P=> /in_n i_n /in_n j_n ne unlisted; change (apart n R y (real gap) (Disks i j)).
have reach k l : k \in iota 0 n -> l \in iota 0 n -> out_of_reach x error gap widest k l ->
    apart n R y (real gap) (Disks k l).
  by move=> /sizes/andP[k0 k1] /sizes/andP[l0 l1]; apply: out_of_reach_is_apart; lia.
have total : total (left_of x) by move=> k l; rewrite /left_of; lia.
have := sweep_covers (sort_sorted total _) swept; move=> /(_ i j); rewrite !mem_sort => /(_ i_n j_n ne).
case=> [[ok|out]|[ok|out]]; 
  [exact: of_settled|exact: reach out|apply/apart_of_disks/(of_settled _ ok)|exact/apart_of_disks/reach].
apply: contra unlisted; rewrite /listed; apply: sub_has => -[k l|k a|k a] //=.
by rewrite ![(j == _) && _]andbC orbC.
Qed.
End Apart.
Print Assumptions other_grains_are_apart.
