(** Statement K9 (../checker.md) for a box and a cell: grains that no listed contact joins are apart by a stated gap.

    Disks, moved into the cell by periods, and their images near it are sorted by x; each is compared with those that
    follow, until one is too far. The coordinates are integers within [error] of the true ones, and equal to them where
    they are held. Pairs that cannot move need not have a gap. *)
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
  | Image i j k l, Image i' j' k' l' => [&& i == i', j == j', Z.eqb k k' & Z.eqb l l']
      || [&& i == j', j == i', Z.eqb k (Z.opp k') & Z.eqb l (Z.opp l')]
  | Lower i a, Lower k b | Upper i a, Upper k b => (i == k) && (a == b)
  | _, _ => false
  end.
Definition listed (contacts : seq contact) (c : contact) : bool := has (same c) contacts.

(** No coordinate of a pair moves. *)
Definition held (contacts : seq contact) (k : nat) : bool := has (fun c => if c is Held m then m == k else false) contacts.
Definition immobile (n : nat) (contacts : seq contact) (c : contact) : bool := all (held contacts) (coordinates n c).

(** A disk or an image, as what is asked of it, read once: number and periods, whether it is the one in the cell, and
    x, y, radius. *)
Definition sight : Type := Z * (Z * Z) * bool * (Z * Z * Z).
Definition number (s : sight) : Z := s.1.1.1.
Definition periods (s : sight) : Z * Z := s.1.1.2.
Definition central (s : sight) : bool := s.1.2.
Definition abscissa (s : sight) : Z := s.2.1.1.
Definition ordinate (s : sight) : Z := s.2.1.2.
Definition size_of (s : sight) : Z := s.2.2.

Section Far.
Variables (n : nat) (radius x : nat -> Z) (error gap : Z).
Local Open Scope Z_scope.

(** A length that is within [e] of u is this at least. *)
Definition surely (u e : Z) : Z := Z.max 0 (Z.abs u - e).
Definition least_separation (i j : nat) (k l : Z) (a : nat) : Z :=
  surely (separation n x i j k l a) (Z.of_nat (spread (along n i j k l a)) * error).
Definition far (c : contact) : bool :=
  match c with
  | Image i j k l => let d := radius i + radius j + gap in
      d * d <=? least_separation i j k l 0 * least_separation i j k l 0 + least_separation i j k l 1 * least_separation i j k l 1
  | Lower i a => radius i + gap + error <=? x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap + 2 * error <=? x (n.*2 + a)%N
  | Held _ => false
  end.
End Far.

Section Sweep.
Variables (n : nat) (walls periodic : seq bool) (contacts : seq contact) (radius place x : nat -> Z) (error gap widest : Z).
Local Open Scope Z_scope.

(** "if" spares the next question where one is answered; a disjunction would compute all. *)
Definition settled (c : contact) : bool :=
  if far n radius x error gap c then true else if listed contacts c then true
  else if immobile n contacts c then far n radius x 0 0 c else false.

(** Disks and images fewer than 256 periods away are known so well. Two whose distance along one axis alone is [reach]
    are apart. *)
Definition blur : Z := 256 * error.
Definition reach : Z := 2 * widest + gap + 2 * blur.

Definition far_seen (s t : sight) : bool :=
  let d := size_of s + size_of t + gap in
  let dx := surely (abscissa s - abscissa t) (2 * blur) in let dy := surely (ordinate s - ordinate t) (2 * blur) in
  d * d <=? dx * dx + dy * dy.

(** Contacts in binary numbers. *)
Definition code (c : contact) : Z * Z * (Z * Z) :=
  match c with Image i j k l => (Z.of_nat i, Z.of_nat j, (k, l)) | _ => (-1, -1, (0, 0)) end.
Definition joined (codes : seq (Z * Z * (Z * Z))) (i j k l : Z) : bool :=
  has (fun p => (if i =? p.1.1 then [&& j =? p.1.2, k =? p.2.1 & l =? p.2.2] else false)
    || (if i =? p.1.2 then [&& j =? p.1.1, k =? - p.2.1 & l =? - p.2.2] else false)) codes.
Definition pair_of (s t : sight) : contact :=
  Image (Z.to_nat (number s)) (Z.to_nat (number t)) ((periods t).1 - (periods s).1) ((periods t).2 - (periods s).2).
Definition settled_seen (codes : seq (Z * Z * (Z * Z))) (s t : sight) : bool :=
  if central s || central t then
    if far_seen s t then true
    else if joined codes (number s) (number t) ((periods t).1 - (periods s).1) ((periods t).2 - (periods s).2) then true
    else if immobile n contacts (pair_of s t) then far n radius x 0 0 (pair_of s t) else false
  else true.
Definition left_of (s t : sight) : bool := abscissa s <=? abscissa t.
Definition beyond (d : Z) : bool := reach <=? d.
Definition out_of_reach (s t : sight) : bool := beyond (abscissa t - abscissa s).
Fixpoint settled_until_far (codes : seq (Z * Z * (Z * Z))) (s : sight) (others : seq sight) : bool :=
  if others is t :: rest then
    if out_of_reach s t then true else if settled_seen codes s t then settled_until_far codes s rest else false
  else true.
Fixpoint sweep (codes : seq (Z * Z * (Z * Z))) (order : seq sight) : bool :=
  if order is s :: rest then if settled_until_far codes s rest then sweep codes rest else false else true.

(** By so many periods a disk is moved out of the cell. *)
Definition wraps (i : nat) : Z * Z :=
  let l := if nth false periodic 1 then x (i.*2 + 1)%N / x n.*2.+1 else 0 in
  (if nth false periodic 0 then (x i.*2 - l * x n.*2.+2) / x n.*2 else 0, l).
Definition seen (i : nat) (d : Z * Z) : sight :=
  let w := wraps i in let k := d.1 - w.1 in let l := d.2 - w.2 in
  (Z.of_nat i, (k, l), (d.1 =? 0) && (d.2 =? 0), (image_at n x i k l 0, image_at n x i k l 1, radius i)).

(** Where those in the cell are; the cell begins at 0. *)
Definition inside : seq sight := [seq seen i (0, 0) | i <- iota 0 n].
Definition lowest (f : sight -> Z) : Z := foldr (fun s => Z.min (f s)) 0 inside.
Definition highest (f : sight -> Z) : Z := foldr (fun s => Z.max (f s)) 0 inside.

(** Images within so many periods are looked at, if they are near the cell. *)
Definition rows_of_images (low high : Z) : Z :=
  if nth false periodic 1 then Z.min 16 ((high - low + reach) / (x n.*2.+1 - error)) else 0.
Definition columns_of_images (low high rows : Z) : Z :=
  if nth false periodic 0 then Z.min 16 ((high - low + reach + rows * (Z.abs (x n.*2.+2) + error)) / (x n.*2 - error)) else 0.
Definition steps (m : Z) : seq Z := [seq Z.of_nat k - m | k <- iota 0 (Z.to_nat (2 * m + 1))].
Definition places (columns rows : Z) : seq sight :=
  [seq seen i d | i <- iota 0 n, d <- [seq (k, l) | k <- steps columns, l <- steps rows]].

Definition near_cell (x0 x1 y0 y1 : Z) (s : sight) : bool :=
  ~~ [|| beyond (x0 - abscissa s), beyond (abscissa s - x1), beyond (y0 - ordinate s) | beyond (ordinate s - y1)].
Definition in_extent (x0 x1 y0 y1 : Z) (s : sight) : bool :=
  [&& x0 <=? abscissa s, abscissa s <=? x1, y0 <=? ordinate s & ordinate s <=? y1].
Definition well_known (s : sight) : bool := 1 + Z.abs (periods s).1 + Z.abs (periods s).2 <=? 256.

Definition pairs_settled : bool :=
  let x0 := lowest abscissa in let x1 := highest abscissa in let y0 := lowest ordinate in let y1 := highest ordinate in
  let rows := rows_of_images y0 y1 in let columns := columns_of_images x0 x1 rows in
  let all_places := places columns rows in
  [&& all (in_extent x0 x1 y0 y1) inside, (0 <=? rows) && (0 <=? columns), all well_known all_places,
    (if nth false periodic 1 then y1 - y0 + reach <=? (rows + 1) * (x n.*2.+1 - error) else true)
    && (if nth false periodic 0
        then x1 - x0 + reach + rows * (Z.abs (x n.*2.+2) + error) <=? (columns + 1) * (x n.*2 - error) else true)
    & sweep [seq code c | c <- contacts] (sort left_of [seq s <- all_places | near_cell x0 x1 y0 y1 s])].

Definition settled_wall (k : nat) (c : contact) : bool := if nth false walls k then settled c else true.
Definition walls_settled (i : nat) : bool :=
  [&& settled_wall 0 (Lower i 0), settled_wall 1 (Lower i 1), settled_wall 2 (Upper i 0) & settled_wall 3 (Upper i 1)].
Definition kept : bool := all (fun c => if c is Held k then x k =? place k else true) contacts.
Definition gaps_check : bool :=
  [&& 0 <? gap, 0 <=? error, all (fun i => (0 <=? radius i) && (radius i <=? widest)) (iota 0 n), pairs_settled
    & kept && all walls_settled (iota 0 n)].

Let codes := [seq code c | c <- contacts].
Lemma joined_is_listed i j k l : joined codes (Z.of_nat i) (Z.of_nat j) k l = listed contacts (Image i j k l).
Proof.
rewrite /joined /listed has_map; apply: eq_has => -[i' j' k' l'|i' a|i' a|m] /=; last 3 first.
- by case: ifP => // /Z.eqb_eq; lia.
- by case: ifP => // /Z.eqb_eq; lia.
- by case: ifP => // /Z.eqb_eq; lia.
have same_number u v : Z.eqb (Z.of_nat u) (Z.of_nat v) = (u == v) by apply/idP/idP; lia.
by rewrite !same_number; case: (i == i'); case: (i == j').
Qed.

Let settled_or_far (s t : sight) : Prop := settled_seen codes s t \/ out_of_reach s t.

Let left_of_transitive : transitive left_of.
Proof. by move=> t s u; rewrite /left_of; lia. Qed.
Let left_of_total : total left_of.
Proof. by move=> s t; rewrite /left_of; lia. Qed.

Let until_far s others : path left_of s others -> settled_until_far codes s others ->
  forall t, t \in others -> settled_or_far s t.
Proof.
elim: others => //= u rest IH /andP[su sorted] check t.
have /allP min := order_path_min left_of_transitive sorted.
case: ifP check => [out _|_].
  rewrite inE => /orP[/eqP->|/min ut]; first by right.
  by right; move: out ut; rewrite /out_of_reach /beyond /left_of; lia.
case: ifP => // ok rest_ok; rewrite inE => /orP[/eqP->|tr]; first by left.
apply: IH => //; case: (rest) sorted => //= m r /andP[um ->]; rewrite andbT.
exact: left_of_transitive su um.
Qed.

Lemma sweep_covers order : sorted left_of order -> sweep codes order -> forall s t, s \in order -> t \in order -> s != t ->
  settled_or_far s t \/ settled_or_far t s.
Proof.
elim: order => //= u rest IH sorted; case: ifP => // first others s t; rewrite !inE.
have rest_sorted : path.sorted left_of rest by apply: path_sorted sorted.
case/orP=> [/eqP->|sr] /orP[/eqP->|tr]; rewrite ?eqxx // => ne.
- by left; apply: until_far tr.
- by right; apply: until_far sr.
- exact: IH.
Qed.

Lemma steps_reach m d : Z.abs d <=? m -> d \in steps m.
Proof.
move=> small; apply/mapP; exists (Z.to_nat (d + m)); last by lia.
by rewrite mem_iota; lia.
Qed.
End Sweep.

Local Open Scope ring_scope.

(** Grains are apart: their distance exceeds that of contact by [gap] at least. *)
Definition apart (F : realFieldType) (n : nat) (radius place x : nat -> F) (gap : F) (c : contact) : Prop :=
  match c with
  | Image i j k l => (radius i + radius j + gap) ^+ 2
      <= (x (i.*2)%N - image_at n x j k l 0) ^+ 2 + (x (i.*2 + 1)%N - image_at n x j k l 1) ^+ 2
  | Lower i a => radius i + gap <= x (i.*2 + a)%N
  | Upper i a => x (i.*2 + a)%N + radius i + gap <= x (n.*2 + a)%N
  | Held k => x k = place k
  end.

Lemma apart_by_separations (F : realFieldType) n (radius place x : nat -> F) gap i j k l :
  apart n radius place x gap (Image i j k l) =
    ((radius i + radius j + gap) ^+ 2 <= separation n x i j k l 0 ^+ 2 + separation n x i j k l 1 ^+ 2).
Proof. by rewrite !separation_is_from_the_image // addn0. Qed.

Section FarApart.
Variables (F : realFieldType) (n : nat) (radius x : nat -> Z) (error gap : Z) (place y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).

(** A square is at least that of any smaller size. *)
Lemma square_above (t d : F) : 0 <= t -> t <= `|d| -> t ^+ 2 <= d ^+ 2.
Proof. by move=> t0 td; rewrite -(real_normK (num_real d)) ler_pexpn2r ?nnegrE. Qed.

Lemma surely_below (u : F) s e : `|u - real s| <= real e -> real (surely s e) ^+ 2 <= u ^+ 2.
Proof.
move=> near; apply: square_above; first by rewrite -(real_zero F) real_le /surely; lia.
rewrite /surely; set m := Z.sub _ _; case: (Z.max_spec Z0 m) => [[_ ->]|[_ ->]]; last by rewrite real_zero normr_ge0.
rewrite /m real_minus -real_abs ler_subl_addr.
have {1}-> : real s = u - (u - real s) by rewrite opprB addrC subrK.
by apply: le_trans (ler_norm_sub _ _) _; rewrite ler_add2l.
Qed.

Let sum_near s : `|sum_at y s - real (sum_at x s)| <= real (Z.of_nat (spread s) * error).
Proof.
rewrite real_times real_of_nat -(sum_at_morphism (real_rmorphism F)).
have -> : sum_at y s - sum_at (real_rmorphism F \o x) s = sum_at (fun k => y k - real (x k)) s.
  by rewrite (@sum_at_combines _ y (real_rmorphism F \o x) (fun k => y k - real (x k)) 1 (-1)) => [|k]; rewrite ?mul1r ?mulN1r.
exact: sum_at_bound.
Qed.

(** Places of images are as well known as their periods are few. *)
Lemma image_near j k l a e : (a < 2)%N -> Z.le (Z.mul (Z.add (Z.add 1 (Z.abs k)) (Z.abs l)) error) e -> Z.le 0 error ->
  `|image_at n y j k l a - real (image_at n x j k l a)| <= real e.
Proof.
move=> a2 few e0; pose s : seq (nat * int) := if a is 0%N then [:: (j.*2, 1); (n.*2, int_of_Z k); (n.*2.+2, int_of_Z l)]
  else [:: ((j.*2 + 1)%N, 1); (n.*2.+1, int_of_Z l)].
have sumE (T : comRingType) (z : nat -> T) : image_at n z j k l a = sum_at z s.
  by rewrite /s /image_at; case: (a) => [|b] /=; rewrite ?mulr1z ?addr0 ?addrA.
rewrite !sumE; apply: le_trans (sum_near s) _; rewrite real_le; apply/Z.leb_le.
have few_s : Z.le (Z.of_nat (spread s)) (Z.add (Z.add 1 (Z.abs k)) (Z.abs l)).
  have : (spread s <= 1 + `|int_of_Z k| + `|int_of_Z l|)%N by rewrite /s; case: (a) => [|b] /=; rewrite addn0 ?addnA ?leq_add2r.
  by lia.
by apply: Z.le_trans few; apply: Z.mul_le_mono_nonneg_r.
Qed.

Let below k : y k <= real (x k) + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)). Qed.
Let above k : real (x k) <= y k + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)) // distrC. Qed.

Lemma far_is_apart c : far n radius x error gap c -> apart n R place y (real gap) c.
Proof.
case: c => [i j k l|i a|i a|k] //.
- rewrite apart_by_separations /far -(real_le F) !(real_plus, real_times) -!expr2 => enough.
  by apply: le_trans enough _; apply: ler_add; apply: surely_below; apply: sum_near.
- by rewrite /far /apart -(real_le F) !(real_plus, real_times) -(ler_add2r (real error)) => /le_trans; apply; apply: above.
rewrite /far /apart -(real_le F) !(real_plus, real_times) => enough.
rewrite -(ler_add2r (real error)); apply: le_trans (above _); apply: le_trans enough.
rewrite (_ : real (Zpos 2) = 1 + 1); last by rewrite -[Zpos 2]/(Z.add 1 1) real_plus rmorph1.
have -> : real (x (i.*2 + a)%N) + real (radius i) + real gap + (1 + 1) * real error
   = (real (x (i.*2 + a)%N) + real error) + (R i + real gap + real error) :> F by rewrite /R; ring.
have -> : y (i.*2 + a)%N + R i + real gap + real error = y (i.*2 + a)%N + (R i + real gap + real error) by ring.
by rewrite ler_add2r below.
Qed.
End FarApart.

Section Apart.
Variables (F : realFieldType) (n : nat) (walls periodic : seq bool) (contacts : seq contact) (radius place x : nat -> Z).
Variables (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).
Let P (k : nat) : F := real (place k).
Hypothesis there : forall k, held contacts k -> y k = P k.
Let apart_by (g : F) c := apart n R P y g c.

(** What is to be shown of a pair. *)
Let good c : Prop := apart_by (real gap) c \/ immobile n contacts c /\ apart_by 0 c.

Lemma held_pairs_are_apart : kept contacts place x -> forall c, immobile n contacts c -> far n radius x 0 0 c -> apart_by 0 c.
Proof.
rewrite /kept => /all_nthP equal c stay far0; pose z k := if held contacts k then y k else real (x k).
have near k : `|z k - real (x k)| <= real 0 :> F.
  rewrite /z real_zero; case: ifP => [h|_]; last by rewrite subrr normr0.
  rewrite there // /P; case/(has_nthP (Lower 0 0)): h => m /(equal (Lower 0 0)).
  case: (nth _ _ _) => // l /Z.eqb_eq xl /eqP <-; by rewrite xl subrr normr0.
have := far_is_apart P near far0; rewrite real_zero /apart_by; move: stay; rewrite /immobile.
case: c {far0} => [i j k l|i a|i a|k].
- rewrite !apart_by_separations => /allP stay.
  by rewrite /separation; do 2?[rewrite (@sum_at_ext _ z y) => [|m ms]; last by rewrite /z stay //= mem_cat ms ?orbT].
- by rewrite /z /= andbT => ->.
- by rewrite /z /= andbT => /andP[-> ->].
by rewrite /z /= andbT => ->.
Qed.

Let turned_separation i j k l a : (a < 2)%N -> separation n y j i (Z.opp k) (Z.opp l) a = - separation n y i j k l a.
Proof.
move=> a2; rewrite !separation_is_from_the_image // /image_at !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz.
by case: a a2 => [|[|a]] // _; rewrite ?addn0; ring.
Qed.
Let turned_is_good i j k l : good (Image j i (Z.opp k) (Z.opp l)) -> good (Image i j k l).
Proof.
rewrite /good /apart_by !apart_by_separations !turned_separation // !sqrrN ![R j + R i]addrC.
suff -> : immobile n contacts (Image j i (Z.opp k) (Z.opp l)) = immobile n contacts (Image i j k l) by [].
rewrite /immobile /coordinates /along eq_sym !(rmorphN [rmorphism of int_of_Z]) /= !oppr_eq0 !opprK.
case: (i == j); case: (int_of_Z k != 0); case: (int_of_Z l != 0) => //=;
  by case: (held _ (j.*2 + 0)%N); case: (held _ (i.*2 + 0)%N); case: (held _ (j.*2 + 1)%N); case: (held _ (i.*2 + 1)%N);
    rewrite /= ?andbF.
Qed.
Let turn_good i j k l : good (Image i j k l) -> good (Image j i (Z.opp k) (Z.opp l)).
Proof. by move=> g; apply: turned_is_good; rewrite !Z.opp_involutive. Qed.
Let turned_is_listed i j k l : listed contacts (Image j i (Z.opp k) (Z.opp l)) = listed contacts (Image i j k l).
Proof.
apply: eq_has => -[i' j' k' l'|i' a|i' a|m] //=.
by apply/idP/idP; lia.
Qed.

Hypothesis gap0 : Z.lt 0 gap.
Hypothesis error0 : Z.le 0 error.
Hypothesis sizes : forall i, (i < n)%N -> Z.le 0 (radius i) /\ Z.le (radius i) widest.

Let good_along i j k l a : (a < 2)%N -> (i < n)%N -> (j < n)%N ->
  real (2 * widest + gap)%Z <= `|separation n y i j k l a| -> good (Image i j k l).
Proof.
move=> a2 /sizes[i0 iw] /sizes[j0 jw] enough; left; rewrite /apart_by apart_by_separations.
have large : (R i + R j + real gap) ^+ 2 <= separation n y i j k l a ^+ 2.
  rewrite /R -!real_plus; apply: square_above; first by rewrite -(real_zero F) real_le; lia.
  by apply: le_trans enough; rewrite real_le; lia.
by apply: le_trans large _; case: a a2 {enough} => [|[|a]] // _; rewrite ?ler_addl ?ler_addr sqr_ge0.
Qed.

Let seen_at := seen n periodic radius x.
Let along_axis (s : sight) (a : nat) : Z := if a is 0%N then abscissa s else ordinate s.
Let place_of i (s : sight) a : F := image_at n y i (periods s).1 (periods s).2 a.
Let e2 : Z := blur error.

Let place_is_known i d a : (a < 2)%N -> well_known (seen_at i d) ->
  `|place_of i (seen_at i d) a - real (along_axis (seen_at i d) a)| <= real e2.
Proof.
move=> a2 /Z.leb_le few; have -> : along_axis (seen_at i d) a = image_at n x i (periods (seen_at i d)).1 (periods (seen_at i d)).2 a.
  by case: a a2 => [|[|a]].
by apply: (image_near n close i a2 _ error0); rewrite /e2 /blur; nia.
Qed.

Let far_from_few (u d : F) p q r : `|u| <= real p -> real q <= `|d| -> Z.le (Z.add r p) q -> real r <= `|u - d|.
Proof.
move=> small large /Z.leb_le; rewrite -(real_le F) real_plus => sum.
rewrite distrC; apply: le_trans (ler_dist_dist _ _); apply: le_trans (ler_norm _).
by rewrite ler_subr_addr; apply: le_trans (ler_add (lexx _) small) _; apply: le_trans sum large.
Qed.
Let difference_is_known (u v : F) p q : `|u - real p| <= real e2 -> `|v - real q| <= real e2 ->
  `|(u - v) - real (Z.sub p q)| <= real (Z.mul 2 e2).
Proof.
move=> up vq; have -> : real (Z.mul 2 e2) = real e2 + real e2 :> F by rewrite -real_plus; congr real; lia.
rewrite real_minus; have -> : u - v - (real p - real q) = (u - real p) - (v - real q) by ring.
by apply: le_trans (ler_norm_sub _ _) _; apply: ler_add.
Qed.
Let at_most_away (u : F) p e b : `|u - real p| <= real e -> Z.le (Z.add (Z.abs p) e) b -> `|u| <= real b.
Proof.
move=> near /Z.leb_le; rewrite -(real_le F) real_plus -real_abs; apply: le_trans.
have {1}-> : u = (u - real p) + real p by rewrite subrK.
by rewrite [X in _ <= X]addrC; apply: le_trans (ler_norm_add _ _) _; rewrite ler_add2r.
Qed.
Let at_least_away (u : F) p e b : `|u - real p| <= real e -> Z.le (Z.add b e) (Z.abs p) -> real b <= `|u|.
Proof.
move=> near /Z.leb_le; rewrite -(real_le F) real_plus -real_abs -ler_subr_addr => /le_trans; apply.
rewrite ler_subl_addr; have {1}-> : real p = u - (u - real p) by rewrite opprB addrC subrK.
by apply: le_trans (ler_norm_sub _ _) _; rewrite ler_add2l.
Qed.
Let many_periods k m b : Z.le b (Z.abs m) -> Z.le 0 b -> Z.le error (x k) ->
  real (Z.mul b (Z.sub (x k) error)) <= `|y k *~ int_of_Z m|.
Proof.
move=> bm b0 large; rewrite -mulrzr -[_%:~R]/(real m) normrM real_abs real_times mulrC.
have large0 : 0 <= real (Z.sub (x k) error) :> F by rewrite -(real_zero F) real_le; lia.
apply: ler_pmul => //; try by rewrite -?(real_zero F) real_le; lia.
by apply: at_least_away (close k) _; lia.
Qed.
Let few_periods k m b : Z.le (Z.abs m) b -> `|y k *~ int_of_Z m| <= real (Z.mul b (Z.add (Z.abs (x k)) error)).
Proof.
move=> mb; rewrite -mulrzr -[_%:~R]/(real m) normrM real_abs real_times mulrC.
apply: ler_pmul => //; rewrite -?(real_zero F) ?real_le; try lia.
by apply: at_most_away (close k) _; lia.
Qed.

Let without (k u v : Z) : Z.sub (k + u - v) u = k - v.
Proof. by lia. Qed.

Lemma pairs_are_apart : kept contacts place x -> pairs_settled n periodic contacts radius x error gap widest ->
  forall i j k l, in_the_packing n walls periodic (Image i j k l) -> ~~ listed contacts (Image i j k l) -> good (Image i j k l).
Proof.
move=> equal; rewrite /pairs_settled.
set x0 := lowest _ _ _ _ abscissa; set x1 := highest _ _ _ _ abscissa.
set y0 := lowest _ _ _ _ ordinate; set y1 := highest _ _ _ _ ordinate.
set rows := rows_of_images _ _ _ _ _ _ _ _; set columns := columns_of_images _ _ _ _ _ _ _ _ _.
case/and5P=> /allP extent /andP[rows0 columns0] /allP known /andP[rows_ok columns_ok] swept i j k l.
case/and5P=> i_n j_n ne k_ok l_ok unlisted.
pose w := wraps n periodic x; pose d : Z * Z := (k + (w j).1 - (w i).1, l + (w j).2 - (w i).2).
pose s := seen_at i (Z0, Z0); pose t := seen_at j d; pose c := seen_at j (Z0, Z0).
have s_in : s \in inside n periodic radius x by apply: map_f; rewrite mem_iota.
have c_in : c \in inside n periodic radius x by apply: map_f; rewrite mem_iota.
have /and4P[s0 s1 s2 s3] := extent _ s_in; have /and4P[c0 c1 c2 c3] := extent _ c_in.
have placed m (b : Z * Z) : (m < n)%N -> Z.leb (Z.abs b.1) columns -> Z.leb (Z.abs b.2) rows ->
    seen_at m b \in places n periodic radius x columns rows.
  move=> m_n b1 b2; apply/allpairsP; exists (m, b); split=> //=; first by rewrite mem_iota.
  by apply/allpairsP; exists b; split; [apply: steps_reach|apply: steps_reach|case: (b)].
have s_place : s \in places n periodic radius x columns rows by apply: placed.
have c_place : c \in places n periodic radius x columns rows by apply: placed.
have periods_s : periods s = (- (w i).1, - (w i).2) by [].
have periods_t : periods t = (k - (w i).1, l - (w i).2) by rewrite /t /d /seen_at /seen /periods -/w /= !without.
have periods_c : periods c = (- (w j).1, - (w j).2) by [].
have sep_st a : (a < 2)%N -> separation n y i j k l a = place_of i s a - place_of j t a.
  move=> a2; rewrite separation_is_from_the_image // /place_of periods_s periods_t; case: (w i) => wi wi' /=.
  rewrite /image_at !(rmorphB [rmorphism of int_of_Z]) !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz !mulrzBr.
  by case: a a2 => [|[|a]] // _; rewrite ?addn0; ring.
have y_sep : separation n y i j k l 1 = place_of i s 1 - place_of j c 1 - y n.*2.+1 *~ int_of_Z d.2.
  rewrite sep_st // /place_of periods_t periods_c /d; case: (w i) => wi wi'; case: (w j) => wj wj' /=.
  rewrite /image_at !(rmorphB, rmorphD) !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz !mulrzBr mulrzDl; ring.
have x_sep : separation n y i j k l 0 = place_of i s 0 - place_of j c 0 - y n.*2 *~ int_of_Z d.1 - y n.*2.+2 *~ int_of_Z d.2.
  rewrite sep_st // /place_of periods_t periods_c /d; case: (w i) => wi wi'; case: (w j) => wj wj' /=.
  rewrite /image_at !(rmorphB, rmorphD) !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz !mulrzBr !mulrzDl; ring.
have no_rows : ~~ nth false periodic 1 -> d.2 = Z0.
  by move=> np; move: l_ok; rewrite /d /w /wraps (negPf np) orbF => /eqP ->.
have no_columns : ~~ nth false periodic 0 -> d.1 = Z0.
  by move=> np; move: k_ok; rewrite /d /w /wraps (negPf np) orbF => /eqP ->.
have [si0 siw] := sizes i_n; have reach_is : reach error gap widest = Z.add (Z.add (Z.mul 2 widest) gap) (Z.mul 2 e2) by [].
have e20 : Z.le 0 e2 by rewrite /e2 /blur; clear -error0; lia.
have known_s a : (a < 2)%N -> `|place_of i s a - real (along_axis s a)| <= real e2.
  by move=> a2; apply: place_is_known a2 _; apply: known.
have known_c a : (a < 2)%N -> `|place_of j c a - real (along_axis c a)| <= real e2.
  by move=> a2; apply: place_is_known a2 _; apply: known.
have name_s : number s = Z.of_nat i /\ central s by [].
have name_t : number t = Z.of_nat j by [].
have size_s : size_of s = radius i by []. have size_t : size_of t = radius j by [].
have t_place : Z.leb (Z.abs d.1) columns -> Z.leb (Z.abs d.2) rows -> t \in places n periodic radius x columns rows by apply: placed.
have known_t a : t \in places n periodic radius x columns rows -> (a < 2)%N -> `|place_of j t a - real (along_axis t a)| <= real e2.
  by move=> tp a2; apply: place_is_known a2 _; apply: known.
have reach0 : Z.le (Z.add (Z.mul 2 e2) 1) (reach error gap widest) by rewrite reach_is; clear -si0 siw gap0; lia.
clearbody x0 x1 y0 y1 rows columns d s t c.
have [d2_few|d2_many] := boolP (Z.leb (Z.abs d.2) rows); last first.
  have p1 : nth false periodic 1 by apply: contraNT d2_many => /no_rows ->.
  rewrite p1 in rows_ok; apply: (good_along (a := 1)) => //; rewrite y_sep.
  apply: (far_from_few (p := (y1 - y0 + Z.mul 2 e2)) (q := Z.mul (Z.add rows 1) (Z.sub (x n.*2.+1) error))).
  - apply: at_most_away (difference_is_known (known_s 1%N isT) (known_c 1%N isT)) _; rewrite /=.
    by clear -s2 s3 c2 c3; lia.
  - by apply: many_periods; clear -rows_ok rows0 s2 s3 reach0 e20 d2_many; nia.
  by rewrite reach_is in rows_ok; clear -rows_ok; lia.
have [d1_few|d1_many] := boolP (Z.leb (Z.abs d.1) columns); last first.
  have p0 : nth false periodic 0 by apply: contraNT d1_many => /no_columns ->.
  rewrite p0 in columns_ok; apply: (good_along (a := 0)) => //; rewrite x_sep addrAC.
  pose tilted := Z.mul rows (Z.add (Z.abs (x n.*2.+2)) error).
  have tilted0 : Z.le 0 tilted by rewrite /tilted; clear -rows0 error0; nia.
  rewrite -/tilted in columns_ok; have := few_periods n.*2.+2 (iffLR (Z.leb_le _ _) d2_few); rewrite -/tilted => tilt_few.
  clearbody tilted.
  apply: (far_from_few (p := (x1 - x0 + Z.mul 2 e2 + tilted)) (q := Z.mul (Z.add columns 1) (Z.sub (x n.*2) error))).
  - rewrite real_plus; apply: le_trans (ler_norm_sub _ _) _; apply: ler_add => //.
    apply: at_most_away (difference_is_known (known_s 0%N isT) (known_c 0%N isT)) _; rewrite /=.
    by clear -s0 s1 c0 c1; lia.
  - by apply: many_periods; clear -columns_ok columns0 s0 s1 reach0 e20 d1_many tilted0; nia.
  by rewrite reach_is in columns_ok; clear -columns_ok; lia.
have t_in := t_place d1_few d2_few; have {}known_t a := known_t a t_in.
have far_along a : (a < 2)%N -> Z.le (reach error gap widest) (Z.abs (Z.sub (along_axis s a) (along_axis t a))) -> good (Image i j k l).
  move=> a2 far_st; apply: (good_along a2) => //; rewrite sep_st //.
  apply: at_least_away (difference_is_known (known_s a a2) (known_t a a2)) _.
  by rewrite reach_is in far_st; clear -far_st; lia.
have [t_near|] := boolP (near_cell error gap widest x0 x1 y0 y1 t); last first.
  rewrite negbK /beyond => /or4P[] out; [apply: (far_along 0%N)|apply: (far_along 0%N)|apply: (far_along 1%N)|apply: (far_along 1%N)] => //;
    by rewrite /along_axis; clear -out s0 s1 s2 s3; lia.
have s_near : near_cell error gap widest x0 x1 y0 y1 s.
  by rewrite /near_cell /beyond; clear -s0 s1 s2 s3 reach0 e20; lia.
have st : s != t.
  apply/negP => /eqP st; move: ne; have ij : i = j by apply: Nat2Z.inj; rewrite -(proj1 name_s) -name_t st.
  have [k0 l0] : - (w i).1 = k - (w i).1 /\ - (w i).2 = l - (w i).2 by move: periods_s; rewrite st periods_t => -[-> ->].
  have none u v : - u = v - u -> v = Z0 :> Z by clear; lia.
  by rewrite ij eqxx (none _ _ k0) (none _ _ l0).
have known_names u p : Z.sub (p - u) (- u) = p /\ Z.sub (- u) (p - u) = Z.opp p by clear; lia.
have far_good : far_seen error gap s t -> good (Image i j k l).
  move=> enough; left; rewrite /apart_by apart_by_separations !sep_st //.
  move: enough; rewrite /far_seen size_s size_t -(real_le F) !(real_plus, real_times) -!expr2 => enough.
  apply: le_trans enough _; apply: ler_add; apply: surely_below.
    exact: difference_is_known (known_s 0%N isT) (known_t 0%N isT).
  exact: difference_is_known (known_s 1%N isT) (known_t 1%N isT).
have turned_far : far_seen error gap t s = far_seen error gap s t.
  have surely_opp p q e : surely (Z.sub p q) e = surely (Z.sub q p) e by rewrite /surely; clear; lia.
  by rewrite /far_seen (surely_opp (abscissa t)) (surely_opp (ordinate t)) (Z.add_comm (size_of t)).
have [k_st k_ts] := known_names (w i).1 k; have [l_st l_ts] := known_names (w i).2 l.
have pair_st : pair_of s t = Image i j k l.
  by rewrite /pair_of (proj1 name_s) name_t periods_s periods_t !Nat2Z.id; congr Image.
have pair_ts : pair_of t s = Image j i (Z.opp k) (Z.opp l).
  by rewrite /pair_of (proj1 name_s) name_t periods_s periods_t !Nat2Z.id; congr Image.
have settle u v i' j' k' l' : settled_seen n contacts radius x error gap [seq code c | c <- contacts] u v -> central u || central v ->
    pair_of u v = Image i' j' k' l' -> number u = Z.of_nat i' -> number v = Z.of_nat j' -> (far_seen error gap u v -> good (Image i' j' k' l')) ->
    ~~ listed contacts (Image i' j' k' l') -> good (Image i' j' k' l').
  rewrite /settled_seen => + one pair_uv nu nv close_far none; rewrite one pair_uv; case: ifP => [/close_far //|_].
  have [kE lE] : Z.sub (periods v).1 (periods u).1 = k' /\ Z.sub (periods v).2 (periods u).2 = l' by case: pair_uv.
  rewrite kE lE nu nv joined_is_listed (negPf none); case: ifP => // stay far0; right; split=> //; exact: held_pairs_are_apart.
have turn : (far_seen error gap t s -> good (Image j i (Z.opp k) (Z.opp l))) by rewrite turned_far => /far_good /turn_good.
have unlisted' : ~~ listed contacts (Image j i (Z.opp k) (Z.opp l)) by rewrite turned_is_listed.
have total_order : total left_of by move=> u v; rewrite /left_of; clear; lia.
have := sweep_covers (sort_sorted total_order _) swept; move=> /(_ s t).
rewrite !mem_sort !mem_filter s_near s_place t_near t_in => /(_ isT isT st).
case=> [[settled_st|]|[settled_ts|]].
- by apply: (settle _ _ _ _ _ _ settled_st _ pair_st (proj1 name_s) name_t far_good unlisted); rewrite (proj2 name_s).
- by rewrite /out_of_reach /beyond => out; apply: (far_along 0%N) => //; rewrite /along_axis; clear -out; lia.
- apply: turned_is_good; apply: (settle _ _ _ _ _ _ settled_ts _ pair_ts name_t (proj1 name_s) turn unlisted').
  by rewrite (proj2 name_s) orbT.
by rewrite /out_of_reach /beyond => out; apply: (far_along 0%N) => //; rewrite /along_axis; clear -out; lia.
Qed.
End Apart.

Section Others.
Variables (F : realFieldType) (n : nat) (walls periodic : seq bool) (contacts : seq contact) (radius place x : nat -> Z).
Variables (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).
Let P (k : nat) : F := real (place k).
Hypothesis there : forall k, held contacts k -> y k = P k.

(** Between grains that cannot move there is no overlap; other gaps exceed the stated one. *)
Theorem other_grains_are_apart c : gaps_check n walls periodic contacts radius place x error gap widest ->
  in_the_packing n walls periodic c -> ~~ holds c -> ~~ listed contacts c ->
  apart n R P y (if immobile n contacts c then 0 else real gap) c.
Proof.
case/and5P=> /Z.ltb_lt g0 /Z.leb_le e0 /allP sizes pairs /andP[equal /allP known] present pair unlisted.
have sizes' i : (i < n)%N -> Z.le 0 (radius i) /\ Z.le (radius i) widest.
  by move=> i_n; have := sizes i; rewrite mem_iota => /(_ i_n)/andP[/Z.leb_le ? /Z.leb_le].
suff [far|[-> //]] : apart n R P y (real gap) c \/ immobile n contacts c /\ apart n R P y 0 c.
  case: ifP => // _; have g1 : 0 <= real gap :> F by rewrite -(real_zero F) real_le; lia.
  have R0 i : (i < n)%N -> 0 <= R i by move=> /sizes'[i0 _]; rewrite -(real_zero F) real_le; lia.
  move: present far; rewrite /apart; case: (c) => [i j k l /and5P[/R0 i0 /R0 j0 _ _ _]|i a _|i a _|k _] //; apply: le_trans.
  - by rewrite ler_pexpn2r ?nnegrE ?addr_ge0 // ler_add2l.
  - by rewrite ler_add2l.
  by rewrite ler_add2l.
have of_settled d : settled n contacts radius x error gap d -> ~~ listed contacts d ->
    apart n R P y (real gap) d \/ immobile n contacts d /\ apart n R P y 0 d.
  rewrite /settled; case: ifP => [/(far_is_apart P close)|_]; first by left.
  case: ifP => // _; case: ifP => // stay far0 _; right; split=> //; exact: (held_pairs_are_apart there equal).
have in_n i : (i < n)%N -> i \in iota 0 n by rewrite mem_iota.
case: c present pair unlisted => [i j k l|i a|i a|k] // present _ unlisted.
- exact: (pairs_are_apart close there g0 e0 sizes' equal pairs present).
- case/and3P: present => /in_n/known/and4P[l0 l1 _ _]; case: a unlisted => [|[|a]] // unlisted _ there_is;
    move: l0 l1; rewrite /settled_wall there_is; first by move=> ok _; apply: of_settled ok unlisted.
  by move=> _ ok; apply: of_settled ok unlisted.
case/and3P: present => /in_n/known/and4P[_ _ u0 u1]; case: a unlisted => [|[|a]] // unlisted _ there_is;
  move: u0 u1; rewrite /settled_wall there_is; first by move=> ok _; apply: of_settled ok unlisted.
by move=> _ ok; apply: of_settled ok unlisted.
Qed.
End Others.
Print Assumptions other_grains_are_apart.
