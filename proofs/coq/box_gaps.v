(** Statement K9 (../checker.md) for a box: grains that no listed contact joins are apart by a stated gap.

    Disks are sorted by x; each is compared with those that follow, until one is too far. The coordinates are integers
    within [error] of the true ones, and equal to them where they are held. Pairs that cannot move need not have a gap. *)
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

(** No coordinate of a pair moves. *)
Definition held (contacts : seq contact) (k : nat) : bool := has (fun c => if c is Held m then m == k else false) contacts.
Definition coordinates (n : nat) (c : contact) : seq nat :=
  match c with
  | Disks i j => [:: i.*2; i.*2 + 1; j.*2; j.*2 + 1]
  | Lower i a => [:: i.*2 + a]
  | Upper i a => [:: n.*2 + a; i.*2 + a]
  | Held k => [:: k]
  end%N.
Definition immobile (n : nat) (contacts : seq contact) (c : contact) : bool := all (held contacts) (coordinates n c).

(** What is asked of a disk, read once, and numbers in binary: (number, (x, y, radius)). *)
Definition sight : Type := Z * (Z * Z * Z).

Section Far.
Variables (n : nat) (radius x : nat -> Z) (error gap : Z).
Local Open Scope Z_scope.

(** Two true coordinates differ by this at least, where the integers are u and v. *)
Definition surely (u v : Z) : Z := Z.max 0 (Z.abs (u - v) - 2 * error).
Definition least_distance (i j a : nat) : Z := surely (x (i.*2 + a)%N) (x (j.*2 + a)%N).
Definition far (c : contact) : bool :=
  match c with
  | Disks i j => let d := radius i + radius j + gap in
      d * d <=? least_distance i j 0 * least_distance i j 0 + least_distance i j 1 * least_distance i j 1
  | Lower i a => radius i + gap + error <=? x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap + 2 * error <=? x (n.*2 + a)%N
  | Held _ => false
  end.
Definition far_seen (s t : sight) : bool :=
  let: (_, (xi, yi, ri)) := s in let: (_, (xj, yj, rj)) := t in
  let d := ri + rj + gap in let dx := surely xi xj in let dy := surely yi yj in d * d <=? dx * dx + dy * dy.
End Far.

Section Sweep.
Variables (n : nat) (walls : seq bool) (contacts : seq contact) (radius place x : nat -> Z) (error gap widest : Z).
Local Open Scope Z_scope.

(** "if" spares the next question where one is answered; a disjunction would compute all. *)
Definition settled (c : contact) : bool :=
  if far n radius x error gap c then true else if listed contacts c then true
  else if immobile n contacts c then far n radius x 0 0 c else false.

Definition left_of (i j : nat) : bool := x (i.*2) <=? x (j.*2).
Definition beyond (dx : Z) : bool := 2 * widest + gap + 2 * error <=? dx.
Definition out_of_reach (i j : nat) : bool := beyond (x (j.*2) - x (i.*2)).
Fixpoint settled_until_far (i : nat) (others : seq nat) : bool :=
  if others is j :: rest then
    if out_of_reach i j then true else settled (Disks i j) && settled_until_far i rest
  else true.
Fixpoint sweep (order : seq nat) : bool :=
  if order is i :: rest then settled_until_far i rest && sweep rest else true.

(** The same with what is seen of the disks, and contacts in binary numbers. *)
Definition seen (i : nat) : sight := (Z.of_nat i, (x (i.*2 + 0)%N, x (i.*2 + 1)%N, radius i)).
Definition code (c : contact) : Z * Z :=
  match c with Disks i j => (Z.of_nat i, Z.of_nat j) | Held k => (Z.of_nat k, -2) | _ => (-1, -1) end.
Definition joined (codes : seq (Z * Z)) (i j : Z) : bool :=
  has (fun p => (i =? p.1) && (j =? p.2) || (i =? p.2) && (j =? p.1)) codes.
Definition stays (codes : seq (Z * Z)) (i : Z) : bool :=
  has (fun p => (p.1 =? 2 * i) && (p.2 =? -2)) codes && has (fun p => (p.1 =? 2 * i + 1) && (p.2 =? -2)) codes.
Definition settled_seen (codes : seq (Z * Z)) (s t : sight) : bool :=
  if far_seen error gap s t then true else if joined codes s.1 t.1 then true
  else if stays codes s.1 && stays codes t.1 then far_seen 0 0 s t else false.
Definition left_seen (s t : sight) : bool := s.2.1.1 <=? t.2.1.1.
Definition out_seen (s t : sight) : bool := beyond (t.2.1.1 - s.2.1.1).
Fixpoint settled_until_far_seen (codes : seq (Z * Z)) (s : sight) (others : seq sight) : bool :=
  if others is t :: rest then
    if out_seen s t then true else if settled_seen codes s t then settled_until_far_seen codes s rest else false
  else true.
Fixpoint sweep_seen (codes : seq (Z * Z)) (order : seq sight) : bool :=
  if order is s :: rest then if settled_until_far_seen codes s rest then sweep_seen codes rest else false else true.

Definition settled_wall (k : nat) (c : contact) : bool := if nth false walls k then settled c else true.
Definition walls_settled (i : nat) : bool :=
  [&& settled_wall 0 (Lower i 0), settled_wall 1 (Lower i 1), settled_wall 2 (Upper i 0) & settled_wall 3 (Upper i 1)].
Definition kept : bool := all (fun c => if c is Held k then x k =? place k else true) contacts.
Definition gaps_check : bool :=
  [&& 0 <=? gap, 0 <=? error, all (fun i => (0 <=? radius i) && (radius i <=? widest)) (iota 0 n),
    sweep_seen [seq code c | c <- contacts] (sort left_seen [seq seen i | i <- iota 0 n])
    & kept && all walls_settled (iota 0 n)].

Lemma joined_is_listed i j : joined [seq code c | c <- contacts] (Z.of_nat i) (Z.of_nat j) = listed contacts (Disks i j).
Proof.
rewrite /joined /listed has_map; apply: eq_has => -[k l|k a|k a|k] /=; last 3 first.
- by apply/negbTE/negP; lia.
- by apply/negbTE/negP; lia.
- by apply/negbTE/negP; lia.
have same_number u v : Z.eqb (Z.of_nat u) (Z.of_nat v) = (u == v) by apply/idP/idP; lia.
by rewrite !same_number.
Qed.
Lemma stays_is_held i : stays [seq code c | c <- contacts] (Z.of_nat i) = held contacts i.*2 && held contacts (i.*2 + 1).
Proof.
have twice : Z.of_nat i.*2 = 2 * Z.of_nat i by lia.
have is_held m : has (fun p => (p.1 =? Z.of_nat m) && (p.2 =? -2)) [seq code c | c <- contacts] = held contacts m.
  by rewrite has_map; apply: eq_has => -[k l|k a|k a|k] /=; rewrite ?andbT ?andbF; apply/idP/idP; lia.
by rewrite /stays -!is_held -twice (_ : Z.of_nat i.*2 + 1 = Z.of_nat (i.*2 + 1)%N) //; lia.
Qed.
Lemma sweep_seen_is_sweep order :
  sweep_seen [seq code c | c <- contacts] [seq seen i | i <- order] = sweep order.
Proof.
elim: order => //= i rest ->; rewrite (_ : settled_until_far_seen _ _ _ = settled_until_far i rest); first by case: ifP.
elim: rest => //= j rest ->; rewrite /out_seen /out_of_reach /= !addn0; case: ifP => // _.
rewrite (_ : settled_seen _ _ _ = settled (Disks i j)); first by case: (settled _).
by rewrite /settled_seen /settled joined_is_listed !stays_is_held /immobile /= andbT -andbA.
Qed.
Definition order : seq nat := sort (relpre seen left_seen) (iota 0 n).
Lemma order_is_sorted : sorted left_of order.
Proof.
apply: (@sub_sorted _ (relpre seen left_seen)) => [i j|]; first by rewrite /left_of /left_seen /= !addn0.
by apply: sort_sorted => i j; rewrite /left_seen /=; lia.
Qed.

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
  by right; move: out kj; rewrite /out_of_reach /beyond /left_of; lia.
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
Definition apart (F : realFieldType) (n : nat) (radius place x : nat -> F) (gap : F) (c : contact) : Prop :=
  match c with
  | Disks i j => (radius i + radius j + gap) ^+ 2
      <= (x (i.*2)%N - x (j.*2)%N) ^+ 2 + (x (i.*2 + 1)%N - x (j.*2 + 1)%N) ^+ 2
  | Lower i a => radius i + gap <= x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap <= x (n.*2 + a)%N
  | Held k => x k = place k
  end.

Section FarApart.
Variables (F : realFieldType) (n : nat) (radius x : nat -> Z) (error gap : Z) (place y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).

(** A square is at least that of any smaller size. *)
Let square_above (t d : F) : 0 <= t -> t <= `|d| -> t ^+ 2 <= d ^+ 2.
Proof. by move=> t0 td; rewrite -(real_normK (num_real d)) ler_pexpn2r ?nnegrE. Qed.

Let distance i j a : real (least_distance x error i j a) ^+ 2 <= (y (i.*2 + a)%N - y (j.*2 + a)%N) ^+ 2.
Proof.
apply: square_above; first by rewrite -(real_zero F) real_le /least_distance /surely; lia.
rewrite /least_distance /surely; set m := Z.sub _ _; case: (Z.max_spec Z0 m) => [[_ ->]|[_ ->]]; last by rewrite real_zero normr_ge0.
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

Lemma far_is_apart c : far n radius x error gap c -> apart n R place y (real gap) c.
Proof.
case: c => [i j|i a|i a|k] //; rewrite /far /apart -(real_le F) !(real_plus, real_times) => enough.
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
End FarApart.

Section Apart.
Variables (F : realFieldType) (n : nat) (walls : seq bool) (contacts : seq contact) (radius place x : nat -> Z).
Variables (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).
Let P (k : nat) : F := real (place k).
Hypothesis there : forall k, held contacts k -> y k = P k.
Let apart_by (g : F) c := apart n R P y g c.

Lemma apart_of_disks g i j : apart_by g (Disks i j) -> apart_by g (Disks j i).
Proof. by rewrite /apart_by /apart [R j + _]addrC -[X in X ^+ 2 + _]opprB -[X in _ + X ^+ 2]opprB !sqrrN. Qed.

Lemma out_of_reach_is_apart i j : 0 <= gap -> 0 <= radius i -> 0 <= radius j -> radius i <= widest -> radius j <= widest ->
  out_of_reach x error gap widest i j -> apart_by (real gap) (Disks i j).
Proof.
move=> g0 Ri0 Rj0 Ri Rj out; apply: (far_is_apart _ close); rewrite /far /least_distance /surely !addn0.
apply/Z.leb_le; move: out; rewrite /out_of_reach /beyond; set d := Z.add (Z.add _ _) gap.
set s := Z.max _ _; set t := Z.max 0 _ => out.
have ds : Z.le d s by rewrite /d /s; lia.
have d0 : Z.le 0 d by rewrite /d; lia.
by nia.
Qed.

Let held_disks : kept contacts place x -> forall c, immobile n contacts c -> far n radius x 0 0 c -> apart_by 0 c.
Proof.
rewrite /kept => /all_nthP equal c stay far0; pose z k := if held contacts k then y k else real (x k).
have near k : `|z k - real (x k)| <= real 0 :> F.
  rewrite /z real_zero; case: ifP => [h|_]; last by rewrite subrr normr0.
  rewrite there // /P; case/(has_nthP (Lower 0 0)): h => m /(equal (Lower 0 0)).
  case: (nth _ _ _) => // l /Z.eqb_eq xl /eqP <-; by rewrite xl subrr normr0.
have := far_is_apart P near far0; rewrite real_zero /apart_by /apart; move: stay; rewrite /immobile /z.
case: c {far0} => [i j|i a|i a|k] /=; rewrite ?andbT.
- by case/and4P=> -> -> -> ->.
- by move=> ->.
- by case/andP=> -> ->.
by move=> ->.
Qed.

Let apart_less c : 0 <= gap -> well_formed n c -> (forall i, i \in iota 0 n -> 0 <= radius i) ->
  apart_by (real gap) c -> apart_by 0 c.
Proof.
move=> g0 formed sizes; have g1 : 0 <= real gap :> F by rewrite -(real_zero F) real_le.
have R0 i : (i < n)%N -> 0 <= R i by move=> i_n; rewrite -(real_zero F) real_le; apply: sizes; rewrite mem_iota.
rewrite /apart_by /apart; case: c formed => [i j /and3P[/R0 i0 /R0 j0 _]|i a _|i a _|k _] //; apply: le_trans.
- by rewrite ler_pexpn2r ?nnegrE ?addr_ge0 // ler_add2l.
- by rewrite ler_add2l.
by rewrite ler_add2l.
Qed.

(** Between grains that cannot move there is no overlap; other gaps exceed the stated one. *)
Theorem other_grains_are_apart c : gaps_check n walls contacts radius place x error gap widest ->
  in_the_packing n walls c -> ~~ holds c -> ~~ listed contacts c ->
  apart_by (if immobile n contacts c then 0 else real gap) c.
Proof.
case/and5P=> g0 _ /allP sizes; rewrite sort_map (sweep_seen_is_sweep n) => swept /andP[equal /allP known].
move=> /andP[formed present] pair unlisted.
suff [far|[-> //]] : apart_by (real gap) c \/ immobile n contacts c /\ apart_by 0 c.
  by case: ifP => // _; apply: apart_less far => // i /sizes/andP[].
have of_settled d : settled n contacts radius x error gap d -> ~~ listed contacts d ->
    apart_by (real gap) d \/ immobile n contacts d /\ apart_by 0 d.
  rewrite /settled; case: ifP => [/(far_is_apart P close)|_]; first by left.
  case: ifP => // _; case: ifP => // stay far0 _; right; split=> //; exact: held_disks.
have in_n i : (i < n)%N -> i \in iota 0 n by rewrite mem_iota.
case: c formed present pair unlisted => [i j|i a|i a|k] //=; last 2 first.
- case/andP=> /in_n/known/and4P[l0 l1 _ _]; case: a => [|[|a]] // _ there_is _; move: l0 l1; rewrite /settled_wall there_is.
    by move=> ok _; apply: of_settled ok.
  by move=> _ ok; apply: of_settled ok.
- case/andP=> /in_n/known/and4P[_ _ u0 u1]; case: a => [|[|a]] // _ there_is _; move: u0 u1; rewrite /settled_wall there_is.
    by move=> ok _; apply: of_settled ok.
  by move=> _ ok; apply: of_settled ok.
case/and3P=> /in_n i_n /in_n j_n ne _ _ unlisted.
have reach k l : k \in iota 0 n -> l \in iota 0 n -> out_of_reach x error gap widest k l -> apart_by (real gap) (Disks k l).
  by move=> /sizes/andP[k0 k1] /sizes/andP[l0 l1]; apply: out_of_reach_is_apart; lia.
have turned : ~~ listed contacts (Disks j i).
  apply: contra unlisted; rewrite /listed; apply: sub_has => -[k l|k a|k a|k] //=.
  by rewrite ![(j == _) && _]andbC orbC.
have := sweep_covers (order_is_sorted n radius x) swept; move=> /(_ i j); rewrite !mem_sort => /(_ i_n j_n ne).
case=> [[ok|out]|[ok|out]].
- exact: of_settled ok unlisted.
- by left; apply: reach out.
- case: (of_settled _ ok turned) => [far|[stay none]]; first by left; apply: apart_of_disks.
  right; split; last exact: apart_of_disks.
  by move: stay; rewrite /immobile /= => /and5P[-> -> -> -> _].
by left; apply/apart_of_disks/reach.
Qed.
End Apart.
Print Assumptions other_grains_are_apart.
