(** Statement K9 (../checker.md) for a box and a cell: grains that no listed contact joins are apart by a stated gap.

    Grains, moved into the cell by periods, and their images near it are sorted by x; each is compared with those that
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
  | Image i j k l m, Image i' j' k' l' m' => [&& i == i', j == j', Z.eqb k k', Z.eqb l l' & Z.eqb m m']
      || [&& i == j', j == i', Z.eqb k (Z.opp k'), Z.eqb l (Z.opp l') & Z.eqb m (Z.opp m')]
  | Lower i a, Lower k b | Upper i a, Upper k b => (i == k) && (a == b)
  | _, _ => false
  end.
Definition listed (contacts : seq contact) (c : contact) : bool := has (same c) contacts.

(** No coordinate of a pair moves. *)
Definition held (contacts : seq contact) (k : nat) : bool := has (fun c => if c is Held m then m == k else false) contacts.
Definition immobile (d : dimension) (n : nat) (contacts : seq contact) (c : contact) : bool := all (held contacts) (coordinates d n c).

(** A grain or an image, as what is asked of it, read once: number and periods, whether it is the one in the cell, and
    x, y, z, radius. In the plane z is 0. *)
Definition sight : Type := Z * (Z * Z * Z) * bool * (Z * Z * Z * Z).
Definition number (s : sight) : Z := s.1.1.1.
Definition periods (s : sight) : Z * Z * Z := s.1.1.2.
Definition central (s : sight) : bool := s.1.2.
Definition abscissa (s : sight) : Z := s.2.1.1.1.
Definition ordinate (s : sight) : Z := s.2.1.1.2.
Definition applicate (s : sight) : Z := s.2.1.2.
Definition size_of (s : sight) : Z := s.2.2.

Section Far.
Variables (d : dimension) (n : nat) (radius x : nat -> Z) (error gap : Z).
Local Open Scope Z_scope.

(** A length that is within [e] of u is this at least. *)
Definition surely (u e : Z) : Z := Z.max 0 (Z.abs u - e).
Definition least_separation (i j : nat) (k l m : Z) (a : nat) : Z :=
  surely (separation d n x i j k l m a) (Z.of_nat (spread (along d n i j k l m a)) * error).
Definition far (c : contact) : bool :=
  match c with
  | Image i j k l m => let u := radius i + radius j + gap in
      u * u <=? over d (fun a => let s := least_separation i j k l m a in s * s)
  | Lower i a => radius i + gap + error <=? x (i * d + a)%N
  | Upper i a => x (i * d + a)%N + radius i + gap + 2 * error <=? x (n * d + a)%N
  | Held _ => false
  end.
End Far.

Section Sweep.
Variables (d : dimension) (n : nat) (walls periodic : seq bool) (contacts : seq contact) (radius place x : nat -> Z).
Variables (error gap widest : Z).
Local Open Scope Z_scope.

(** "if" spares the next question where one is answered; a disjunction would compute all. *)
Definition settled (c : contact) : bool :=
  if far d n radius x error gap c then true else if listed contacts c then true
  else if immobile d n contacts c then far d n radius x 0 0 c else false.

(** Grains and images fewer than 256 periods away are known so well. Two whose distance along one axis alone is [reach]
    are apart. *)
Definition blur : Z := 256 * error.
Definition reach : Z := 2 * widest + gap + 2 * blur.

Definition far_seen (s t : sight) : bool :=
  let u := size_of s + size_of t + gap in let e := 2 * blur in
  let dx := surely (abscissa s - abscissa t) e in let dy := surely (ordinate s - ordinate t) e in
  let dz := surely (applicate s - applicate t) e in u * u <=? dx * dx + dy * dy + dz * dz.

(** Contacts in binary numbers. *)
Definition code (c : contact) : Z * Z * (Z * Z * Z) :=
  match c with Image i j k l m => (Z.of_nat i, Z.of_nat j, (k, l, m)) | _ => (-1, -1, (0, 0, 0)) end.
Definition joined (codes : seq (Z * Z * (Z * Z * Z))) (i j k l m : Z) : bool :=
  has (fun p => (if i =? p.1.1 then [&& j =? p.1.2, k =? p.2.1.1, l =? p.2.1.2 & m =? p.2.2] else false)
    || (if i =? p.1.2 then [&& j =? p.1.1, k =? - p.2.1.1, l =? - p.2.1.2 & m =? - p.2.2] else false)) codes.
Definition periods_between (s t : sight) : Z * Z * Z :=
  let p := periods s in let q := periods t in (q.1.1 - p.1.1, q.1.2 - p.1.2, q.2 - p.2).
Definition pair_of (s t : sight) : contact :=
  let p := periods_between s t in Image (Z.to_nat (number s)) (Z.to_nat (number t)) p.1.1 p.1.2 p.2.
Definition settled_seen (codes : seq (Z * Z * (Z * Z * Z))) (s t : sight) : bool :=
  if central s || central t then
    if far_seen s t then true
    else if (let p := periods_between s t in joined codes (number s) (number t) p.1.1 p.1.2 p.2) then true
    else if immobile d n contacts (pair_of s t) then far d n radius x 0 0 (pair_of s t) else false
  else true.
Definition left_of (s t : sight) : bool := abscissa s <=? abscissa t.
Definition beyond (u : Z) : bool := reach <=? u.
Definition out_of_reach (s t : sight) : bool := beyond (abscissa t - abscissa s).
Fixpoint settled_until_far (codes : seq (Z * Z * (Z * Z * Z))) (s : sight) (others : seq sight) : bool :=
  if others is t :: rest then
    if out_of_reach s t then true else if settled_seen codes s t then settled_until_far codes s rest else false
  else true.
Fixpoint sweep (codes : seq (Z * Z * (Z * Z * Z))) (order : seq sight) : bool :=
  if order is s :: rest then if settled_until_far codes s rest then sweep codes rest else false else true.

(** By so many periods a grain is moved out of the cell. [cell]: lengths, then tilts xy, xz, yz. *)
Let cell (b : nat) : Z := x (n * d + b)%N.
Definition wraps (i : nat) : Z * Z * Z :=
  let m := if repeats d periodic 2 then x (i * d + 2)%N / cell 2 else 0 in
  let l := if repeats d periodic 1 then (x (i * d + 1)%N - m * cell d.+2) / cell 1 else 0 in
  (if repeats d periodic 0 then (x (i * d + 0)%N - l * cell d - m * cell d.+1) / cell 0 else 0, l, m).
Definition seen (i : nat) (p : Z * Z * Z) : sight :=
  let w := wraps i in let k := p.1.1 - w.1.1 in let l := p.1.2 - w.1.2 in let m := p.2 - w.2 in
  (Z.of_nat i, (k, l, m), [&& p.1.1 =? 0, p.1.2 =? 0 & p.2 =? 0],
    (image_at d n x i k l m 0, image_at d n x i k l m 1, if d is Plane then 0 else image_at d n x i k l m 2, radius i)).

(** Where those in the cell are; the cell begins at 0. *)
Definition inside : seq sight := [seq seen i (0, 0, 0) | i <- iota 0 n].
Definition lowest (f : sight -> Z) : Z := foldr (fun s => Z.min (f s)) 0 inside.
Definition highest (f : sight -> Z) : Z := foldr (fun s => Z.max (f s)) 0 inside.

(** Images within so many periods are looked at, if they are near the cell: further ones are out of reach. Images m
    periods along z are moved by tilts along x and y, those l periods along y by one along x. *)
Definition moved (m : Z) (b : nat) : Z := m * (Z.abs (cell b) + error).
Definition images (a : nat) (extent : Z) : Z := if repeats d periodic a then Z.min 16 (extent / (cell a - error)) else 0.
Definition enough (a : nat) (extent m : Z) : bool := if repeats d periodic a then extent <=? (m + 1) * (cell a - error) else true.
Definition steps (m : Z) : seq Z := [seq Z.of_nat k - m | k <- iota 0 (Z.to_nat (2 * m + 1))].
Definition places (columns rows layers : Z) : seq sight :=
  [seq seen i p | i <- iota 0 n,
    p <- [seq (kl, m) | kl <- [seq (k, l) | k <- steps columns, l <- steps rows], m <- steps layers]].

Definition near_cell (x0 x1 y0 y1 z0 z1 : Z) (s : sight) : bool :=
  ~~ [|| beyond (x0 - abscissa s), beyond (abscissa s - x1), beyond (y0 - ordinate s), beyond (ordinate s - y1),
    beyond (z0 - applicate s) | beyond (applicate s - z1)].
Definition in_extent (x0 x1 y0 y1 z0 z1 : Z) (s : sight) : bool :=
  [&& (x0 <=? abscissa s) && (abscissa s <=? x1), (y0 <=? ordinate s) && (ordinate s <=? y1)
    & (z0 <=? applicate s) && (applicate s <=? z1)].
Definition well_known (s : sight) : bool :=
  let p := periods s in 1 + Z.abs p.1.1 + Z.abs p.1.2 + Z.abs p.2 <=? 256.

Definition pairs_settled : bool :=
  let x0 := lowest abscissa in let x1 := highest abscissa in let y0 := lowest ordinate in let y1 := highest ordinate in
  let z0 := lowest applicate in let z1 := highest applicate in
  let along_z := z1 - z0 + reach in let layers := images 2 along_z in
  let along_y := y1 - y0 + reach + moved layers d.+2 in let rows := images 1 along_y in
  let along_x := x1 - x0 + reach + moved rows d + moved layers d.+1 in let columns := images 0 along_x in
  let all_places := places columns rows layers in
  [&& all (in_extent x0 x1 y0 y1 z0 z1) inside, [&& 0 <=? layers, 0 <=? rows & 0 <=? columns], all well_known all_places,
    [&& enough 2 along_z layers, enough 1 along_y rows & enough 0 along_x columns]
    & sweep [seq code c | c <- contacts] (sort left_of [seq s <- all_places | near_cell x0 x1 y0 y1 z0 z1 s])].

Definition settled_wall (k : nat) (c : contact) : bool := if nth false walls k then settled c else true.
Definition walls_settled (i : nat) : bool :=
  all (fun a => settled_wall a (Lower i a) && settled_wall (d + a) (Upper i a)) (iota 0 d).
Definition kept : bool := all (fun c => if c is Held k then x k =? place k else true) contacts.
Definition gaps_check : bool :=
  [&& 0 <? gap, 0 <=? error, all (fun i => (0 <=? radius i) && (radius i <=? widest)) (iota 0 n), pairs_settled
    & kept && all walls_settled (iota 0 n)].

Let codes := [seq code c | c <- contacts].
Lemma joined_is_listed i j k l m : joined codes (Z.of_nat i) (Z.of_nat j) k l m = listed contacts (Image i j k l m).
Proof.
rewrite /joined /listed has_map; apply: eq_has => -[i' j' k' l' m'|i' a|i' a|p] /=; last 3 first.
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

Lemma steps_reach m u : Z.abs u <=? m -> u \in steps m.
Proof.
move=> small; apply/mapP; exists (Z.to_nat (u + m)); last by lia.
by rewrite mem_iota; lia.
Qed.
End Sweep.

Local Open Scope ring_scope.

(** Grains are apart: their distance exceeds that of contact by [gap] at least. *)
Definition apart (F : realFieldType) (d : dimension) (n : nat) (radius place x : nat -> F) (gap : F) (c : contact) : Prop :=
  match c with
  | Image i j k l m => (radius i + radius j + gap) ^+ 2 <= distance2 d n x i j k l m
  | Lower i a => radius i + gap <= x (i * d + a)%N
  | Upper i a => x (i * d + a)%N + radius i + gap <= x (n * d + a)%N
  | Held k => x k = place k
  end.

Section FarApart.
Variables (F : realFieldType) (d : dimension) (n : nat) (radius x : nat -> Z) (error gap : Z) (place y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).

(** A square is at least that of any smaller size. *)
Lemma square_above (t u : F) : 0 <= t -> t <= `|u| -> t ^+ 2 <= u ^+ 2.
Proof. by move=> t0 tu; rewrite -(real_normK (num_real u)) ler_pexpn2r ?nnegrE. Qed.

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
Lemma image_near j k l m a e : Z.le (Z.mul (Z.add (Z.add (Z.add 1 (Z.abs k)) (Z.abs l)) (Z.abs m)) error) e -> Z.le 0 error ->
  `|image_at d n y j k l m a - real (image_at d n x j k l m a)| <= real e.
Proof.
move=> few e0; pose cell b := (n * d + b)%N; pose s : seq (nat * int) := ((j * d + a)%N, 1) :: match a with
  | 0%N => [:: (cell 0%N, int_of_Z k); (cell d, int_of_Z l); (cell d.+1, int_of_Z m)]
  | 1%N => [:: (cell 1%N, int_of_Z l); (cell d.+2, int_of_Z m)]
  | _ => [:: (cell 2%N, int_of_Z m)] end.
have sumE (T : comRingType) (z : nat -> T) : image_at d n z j k l m a = sum_at z s.
  by rewrite /s /image_at /= mulr1z; congr (_ + _); case: (a) => [|[|b]] /=; rewrite addr0 ?addrA.
rewrite !sumE; apply: le_trans (sum_near s) _; rewrite real_le; apply/Z.leb_le.
have few_s : Z.le (Z.of_nat (spread s)) (Z.add (Z.add (Z.add 1 (Z.abs k)) (Z.abs l)) (Z.abs m)).
  have : (spread s <= 1 + `|int_of_Z k| + `|int_of_Z l| + `|int_of_Z m|)%N.
    by rewrite /s; case: (a) => [|[|b]] /=; rewrite ?addn0; lia.
  by lia.
by apply: Z.le_trans few; apply: Z.mul_le_mono_nonneg_r.
Qed.

Let below k : y k <= real (x k) + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)). Qed.
Let above k : real (x k) <= y k + real error.
Proof. by rewrite -ler_subl_addl (le_trans (ler_norm _)) // distrC. Qed.

Lemma far_is_apart c : far d n radius x error gap c -> apart d n R place y (real gap) c.
Proof.
case: c => [i j k l m|i a|i a|k] //.
- rewrite /far /apart distance_by_separations -(real_le F) -(over_morphism (real_rmorphism F)) !overE.
  rewrite real_times !real_plus expr2 => /le_trans; apply; apply: ler_sum => a _ /=.
  by rewrite real_times -!expr2; apply: surely_below; apply: sum_near.
- by rewrite /far /apart -(real_le F) !(real_plus, real_times) -(ler_add2r (real error)) => /le_trans; apply; apply: above.
rewrite /far /apart -(real_le F) !(real_plus, real_times) => enough.
rewrite -(ler_add2r (real error)); apply: le_trans (above _); apply: le_trans enough.
rewrite (_ : real (Zpos 2) = 1 + 1); last by rewrite -[Zpos 2]/(Z.add 1 1) real_plus rmorph1.
have -> : real (x (i * d + a)%N) + real (radius i) + real gap + (1 + 1) * real error
   = (real (x (i * d + a)%N) + real error) + (R i + real gap + real error) :> F by rewrite /R; ring.
have -> : y (i * d + a)%N + R i + real gap + real error = y (i * d + a)%N + (R i + real gap + real error) by ring.
by rewrite ler_add2r below.
Qed.
End FarApart.

Section Apart.
Variables (F : realFieldType) (d : dimension) (n : nat) (walls periodic : seq bool) (contacts : seq contact).
Variables (radius place x : nat -> Z).
Variables (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).
Let P (k : nat) : F := real (place k).
Hypothesis there : forall k, held contacts k -> y k = P k.
Let apart_by (g : F) c := apart d n R P y g c.

(** What is to be shown of a pair. *)
Let good c : Prop := apart_by (real gap) c \/ immobile d n contacts c /\ apart_by 0 c.

Lemma held_pairs_are_apart : kept contacts place x -> forall c, immobile d n contacts c -> far d n radius x 0 0 c -> apart_by 0 c.
Proof.
rewrite /kept => /all_nthP equal c stay far0; pose z k := if held contacts k then y k else real (x k).
have near k : `|z k - real (x k)| <= real 0 :> F.
  rewrite /z real_zero; case: ifP => [h|_]; last by rewrite subrr normr0.
  rewrite there // /P; case/(has_nthP (Lower 0 0)): h => m /(equal (Lower 0 0)).
  case: (nth _ _ _) => // l /Z.eqb_eq xl /eqP <-; by rewrite xl subrr normr0.
have := far_is_apart P near far0; rewrite real_zero /apart_by; move: stay; rewrite /immobile.
case: c {far0} => [i j k l m|i a|i a|k].
- rewrite /apart !distance_by_separations => /allP stay.
  rewrite (@over_ext _ d _ (fun a => separation d n y i j k l m a * separation d n y i j k l m a)) // => a ad.
  by rewrite /separation (@sum_at_ext _ z y) // => b /(along_coordinates ad)/stay; rewrite /z => ->.
- by rewrite /z /= andbT => ->.
- by rewrite /z /= andbT => /andP[-> ->].
by rewrite /z /= andbT => ->.
Qed.

Let turned_separation i j k l m a :
  separation d n y j i (Z.opp k) (Z.opp l) (Z.opp m) a = - separation d n y i j k l m a.
Proof.
rewrite !separation_is_from_the_image /image_at !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz.
by case: a => [|[|a]]; ring.
Qed.
Let turned_is_good i j k l m : good (Image j i (Z.opp k) (Z.opp l) (Z.opp m)) -> good (Image i j k l m).
Proof.
rewrite /good /apart_by /apart !distance_by_separations ![R j + R i]addrC.
rewrite (@over_ext _ d _ (fun a => separation d n y i j k l m a * separation d n y i j k l m a)) => [|a _]; last first.
  by rewrite !turned_separation mulrNN.
suff -> : immobile d n contacts (Image j i (Z.opp k) (Z.opp l) (Z.opp m)) = immobile d n contacts (Image i j k l m) by [].
have all_flatten (f : pred nat) ss : all f (flatten ss) = all (all f) ss by elim: ss => //= first ss <-; rewrite all_cat.
rewrite /immobile /coordinates !all_flatten !all_map; apply: eq_all => a /=.
have opp0 (u : Z) : (Z.opp u != Z0) = (u != Z0) by case: u.
rewrite /along eq_sym /unzip1 !map_cat !all_cat; congr (_ && _).
  by case: (i == j) => //=; rewrite !andbT andbC.
by case: a => [|[|a]] /=; rewrite !opp0; do 3?[case: ifP => _].
Qed.
Let turn_good i j k l m : good (Image i j k l m) -> good (Image j i (Z.opp k) (Z.opp l) (Z.opp m)).
Proof. by move=> g; apply: turned_is_good; rewrite !Z.opp_involutive. Qed.
Let turned_is_listed i j k l m :
  listed contacts (Image j i (Z.opp k) (Z.opp l) (Z.opp m)) = listed contacts (Image i j k l m).
Proof.
apply: eq_has => -[i' j' k' l' m'|i' a|i' a|p] //=.
by apply/idP/idP; lia.
Qed.

Hypothesis gap0 : Z.lt 0 gap.
Hypothesis error0 : Z.le 0 error.
Hypothesis sizes : forall i, (i < n)%N -> Z.le 0 (radius i) /\ Z.le (radius i) widest.

Let good_along i j k l m a : (a < d)%N -> (i < n)%N -> (j < n)%N ->
  real (2 * widest + gap)%Z <= `|separation d n y i j k l m a| -> good (Image i j k l m).
Proof.
move=> ad /sizes[i0 iw] /sizes[j0 jw] enough; left; rewrite /apart_by /apart distance_by_separations overE.
rewrite (bigD1 (Ordinal ad)) //= -expr2; apply: le_trans (_ : separation d n y i j k l m a ^+ 2 <= _); last first.
  by rewrite ler_addl sumr_ge0 // => b _; rewrite -expr2 sqr_ge0.
rewrite /R -!real_plus; apply: square_above; first by rewrite -(real_zero F) real_le; lia.
by apply: le_trans enough; rewrite real_le; lia.
Qed.

Let seen_at := seen d n periodic radius x.
Let along_axis (s : sight) (a : nat) : Z := match a with 0%N => abscissa s | 1%N => ordinate s | _ => applicate s end.
Let place_of i (s : sight) a : F := image_at d n y i (periods s).1.1 (periods s).1.2 (periods s).2 a.
Let e2 : Z := blur error.

Let place_is_known i p a : (a < d)%N -> well_known (seen_at i p) ->
  `|place_of i (seen_at i p) a - real (along_axis (seen_at i p) a)| <= real e2.
Proof.
move=> ad /Z.leb_le few; set s := seen_at i p in few *.
have -> : along_axis s a = image_at d n x i (periods s).1.1 (periods s).1.2 (periods s).2 a.
  by move: ad; rewrite /s /seen_at /seen; case: (d) a => [] [|[|[|a]]].
by apply: (image_near d n close i a _ error0); rewrite /e2 /blur; clear -few error0; nia.
Qed.

Let far_from_few (u t : F) p q r : `|u| <= real p -> real q <= `|t| -> Z.le (Z.add r p) q -> real r <= `|u - t|.
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

(** More than [m] periods away along axis a: what tilts and the places in the cell may take away is less. *)
Let many_periods_are_far i j k l m a (u tilt : F) lo hi tilted q p : (a < d)%N -> (i < n)%N -> (j < n)%N ->
  separation d n y i j k l m a = u - tilt - y (n * d + a)%N *~ int_of_Z p ->
  `|u| <= real (Z.add (Z.sub hi lo) (Z.mul 2 e2)) -> `|tilt| <= real tilted ->
  Z.le 0 q -> Z.lt q (Z.abs p) -> Z.le 0 (Z.add (Z.add (Z.sub hi lo) (reach error gap widest)) tilted) ->
  Z.le (Z.add (Z.add (Z.sub hi lo) (reach error gap widest)) tilted) (Z.mul (Z.add q 1) (Z.sub (x (n * d + a)%N) error)) ->
  good (Image i j k l m).
Proof.
move=> ad i_n j_n sep u_small tilt_small q0 many some enough; apply: (good_along ad) => //; rewrite sep.
apply: (far_from_few (p := Z.add (Z.add (Z.sub hi lo) (Z.mul 2 e2)) tilted) (q := Z.mul (Z.add q 1) (Z.sub (x (n * d + a)%N) error))).
- by rewrite real_plus; apply: le_trans (ler_norm_sub _ _) _; apply: ler_add.
- by apply: many_periods; clear -q0 many some enough; nia.
by move: enough; rewrite /reach -/e2; clear; lia.
Qed.

Lemma pairs_are_apart : kept contacts place x -> pairs_settled d n periodic contacts radius x error gap widest ->
  forall i j k l m, in_the_packing d n walls periodic (Image i j k l m) -> ~~ listed contacts (Image i j k l m) ->
  good (Image i j k l m).
Proof.
move=> equal; rewrite /pairs_settled.
set x0 := lowest _ _ _ _ _ abscissa; set x1 := highest _ _ _ _ _ abscissa.
set y0 := lowest _ _ _ _ _ ordinate; set y1 := highest _ _ _ _ _ ordinate.
set z0 := lowest _ _ _ _ _ applicate; set z1 := highest _ _ _ _ _ applicate.
set layers := images _ _ _ _ _ 2 _; set rows := images _ _ _ _ _ 1 _; set columns := images _ _ _ _ _ 0 _.
case/and5P=> /allP extent /and3P[layers0 rows0 columns0] /allP known /and3P[layers_ok rows_ok columns_ok] swept i j k l m.
case/and5P=> i_n j_n ne k_ok /andP[l_ok m_ok] unlisted.
pose w := wraps d n periodic x.
pose p : Z * Z * Z := (k + (w j).1.1 - (w i).1.1, l + (w j).1.2 - (w i).1.2, m + (w j).2 - (w i).2).
pose s := seen_at i (Z0, Z0, Z0); pose t := seen_at j p; pose c := seen_at j (Z0, Z0, Z0).
have s_in : s \in inside d n periodic radius x by apply: map_f; rewrite mem_iota.
have c_in : c \in inside d n periodic radius x by apply: map_f; rewrite mem_iota.
have /and3P[/andP[sx0 sx1] /andP[sy0 sy1] /andP[sz0 sz1]] := extent _ s_in.
have /and3P[/andP[cx0 cx1] /andP[cy0 cy1] /andP[cz0 cz1]] := extent _ c_in.
have placed b (v : Z * Z * Z) : (b < n)%N -> Z.leb (Z.abs v.1.1) columns -> Z.leb (Z.abs v.1.2) rows ->
    Z.leb (Z.abs v.2) layers -> seen_at b v \in places d n periodic radius x columns rows layers.
  move=> b_n v1 v2 v3; apply/allpairsP; exists (b, v); split=> //=; first by rewrite mem_iota.
  apply/allpairsP; exists v; split; [|exact: steps_reach|by case: (v)].
  by apply/allpairsP; exists v.1; split; [apply: steps_reach|apply: steps_reach|case: (v) => -[]].
have s_place : s \in places d n periodic radius x columns rows layers by apply: placed.
have c_place : c \in places d n periodic radius x columns rows layers by apply: placed.
have periods_s : periods s = (- (w i).1.1, - (w i).1.2, - (w i).2) by [].
have periods_t : periods t = (k - (w i).1.1, l - (w i).1.2, m - (w i).2) by rewrite /t /p /seen_at /seen /periods -/w /= !without.
have periods_c : periods c = (- (w j).1.1, - (w j).1.2, - (w j).2) by [].
have sep_st a : separation d n y i j k l m a = place_of i s a - place_of j t a.
  rewrite separation_is_from_the_image /place_of periods_s periods_t; case: (w i) => -[wi wi'] wi'' /=.
  rewrite /image_at !(rmorphB [rmorphism of int_of_Z]) !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz !mulrzBr.
  by case: a => [|[|a]]; ring.
pose cell b := y (n * d + b)%N.
have sep_sc a : separation d n y i j k l m a = place_of i s a - place_of j c a - match a with
    | 0%N => cell d *~ int_of_Z p.1.2 + cell d.+1 *~ int_of_Z p.2 | 1%N => cell d.+2 *~ int_of_Z p.2 | _ => 0 end
    - cell (match a with 0%N => 0%N | 1%N => 1%N | _ => 2%N end) *~ int_of_Z (match a with 0%N => p.1.1 | 1%N => p.1.2 | _ => p.2 end).
  rewrite sep_st // /place_of periods_s periods_t periods_c /p; case: (w i) => -[wi wi'] wi''; case: (w j) => -[wj wj'] wj'' /=.
  rewrite /image_at; case: a => [|[|a]] /=;
  by rewrite !(rmorphB, rmorphD) !(rmorphN [rmorphism of int_of_Z]) /= !mulrNz !mulrzBr !mulrzDl /cell; ring.
have single v a u u' : (v == Z0) || repeats d periodic a -> ~~ repeats d periodic a -> u = Z0 -> u' = Z0 -> v + u - u' = Z0.
  by case/orP=> [/eqP -> _ -> ->|->].
have no_layers : ~~ repeats d periodic 2 -> p.2 = Z0 by move=> np; apply: (single _ _ _ _ m_ok np); rewrite /w /wraps (negPf np).
have no_rows : ~~ repeats d periodic 1 -> p.1.2 = Z0 by move=> np; apply: (single _ _ _ _ l_ok np); rewrite /w /wraps (negPf np).
have no_columns : ~~ repeats d periodic 0 -> p.1.1 = Z0 by move=> np; apply: (single _ _ _ _ k_ok np); rewrite /w /wraps (negPf np).
have [si0 siw] := sizes i_n; have reach_is : reach error gap widest = Z.add (Z.add (Z.mul 2 widest) gap) (Z.mul 2 e2) by [].
have e20 : Z.le 0 e2 by rewrite /e2 /blur; clear -error0; lia.
have known_s a : (a < d)%N -> `|place_of i s a - real (along_axis s a)| <= real e2.
  by move=> ad; apply: place_is_known ad _; apply: known.
have known_c a : (a < d)%N -> `|place_of j c a - real (along_axis c a)| <= real e2.
  by move=> ad; apply: place_is_known ad _; apply: known.
have name_s : number s = Z.of_nat i /\ central s by [].
have name_t : number t = Z.of_nat j by [].
have size_s : size_of s = radius i by []. have size_t : size_of t = radius j by [].
have in_plane : (2 < d)%N \/ d = Plane /\ applicate s = applicate t by rewrite /s /t /seen_at /seen; case: (d); [right|left].
have t_place : Z.leb (Z.abs p.1.1) columns -> Z.leb (Z.abs p.1.2) rows -> Z.leb (Z.abs p.2) layers ->
  t \in places d n periodic radius x columns rows layers by apply: placed.
have known_t a : t \in places d n periodic radius x columns rows layers -> (a < d)%N ->
    `|place_of j t a - real (along_axis t a)| <= real e2.
  by move=> tp ad; apply: place_is_known ad _; apply: known.
have reach0 : Z.le (Z.add (Z.mul 2 e2) 1) (reach error gap widest) by rewrite reach_is; clear -si0 siw gap0; lia.
have repeated a : repeats d periodic a -> (a < d)%N by case/andP.
have moved0 q b : Z.leb Z0 q -> Z.le 0 (moved d n x error q b) by rewrite /moved; clear -error0; nia.
have moved_few q b v : Z.leb (Z.abs v) q -> `|cell b *~ int_of_Z v| <= real (moved d n x error q b).
  by move=> /Z.leb_le; apply: few_periods.
clearbody x0 x1 y0 y1 z0 z1 layers rows columns p s t c.
have between a lo hi : (a < d)%N -> Z.leb lo (along_axis s a) -> Z.leb (along_axis s a) hi -> Z.leb lo (along_axis c a) ->
    Z.leb (along_axis c a) hi -> `|place_of i s a - place_of j c a| <= real (Z.add (Z.sub hi lo) (Z.mul 2 e2)).
  move=> ad s_lo s_hi c_lo c_hi; apply: at_most_away (difference_is_known (known_s a ad) (known_c a ad)) _.
  by clear -s_lo s_hi c_lo c_hi; lia.
have [p2_few|p2_many] := boolP (Z.leb (Z.abs p.2) layers); last first.
  have p2 : repeats d periodic 2 by apply: contraNT p2_many => /no_layers ->.
  rewrite /enough p2 in layers_ok; have ad := repeated _ p2.
  apply: (many_periods_are_far (tilted := Z0) ad i_n j_n (sep_sc 2%N) (between 2%N z0 z1 ad sz0 sz1 cz0 cz1) (q := layers)).
  - by rewrite normr0 real_zero.
  - by clear -layers0; lia.
  - by clear -p2_many; lia.
  - by clear -sz0 sz1 reach0 e20; lia.
  by clear -layers_ok; lia.
have [p1_few|p1_many] := boolP (Z.leb (Z.abs p.1.2) rows); last first.
  have p1 : repeats d periodic 1 by apply: contraNT p1_many => /no_rows ->.
  rewrite /enough p1 in rows_ok; have ad := repeated _ p1; have := moved0 layers d.+2 layers0.
  have := moved_few layers d.+2 _ p2_few; set tilted := moved _ _ _ _ _ _ in rows_ok * => small tilted0.
  apply: (many_periods_are_far ad i_n j_n (sep_sc 1%N) (between 1%N y0 y1 ad sy0 sy1 cy0 cy1) small (q := rows)).
  - by clear -rows0; lia.
  - by clear -p1_many; lia.
  - by clear -sy0 sy1 reach0 e20 tilted0; lia.
  by clear -rows_ok; lia.
have [p0_few|p0_many] := boolP (Z.leb (Z.abs p.1.1) columns); last first.
  have p0 : repeats d periodic 0 by apply: contraNT p0_many => /no_columns ->.
  rewrite /enough p0 in columns_ok; have ad := repeated _ p0.
  have := moved0 layers d.+1 layers0; have := moved0 rows d rows0.
  have := moved_few layers d.+1 _ p2_few; have := moved_few rows d _ p1_few.
  set tilted := moved _ _ _ _ rows _ in columns_ok *; set tilted' := moved _ _ _ _ layers _ in columns_ok *.
  move=> small small' tilted0 tilted0'.
  apply: (many_periods_are_far (tilted := Z.add tilted tilted') ad i_n j_n (sep_sc 0%N) (between 0%N x0 x1 ad sx0 sx1 cx0 cx1) (q := columns)).
  - by rewrite real_plus; apply: le_trans (ler_norm_add _ _) _; apply: ler_add.
  - by clear -columns0; lia.
  - by clear -p0_many; lia.
  - by clear -sx0 sx1 reach0 e20 tilted0 tilted0'; lia.
  by clear -columns_ok; lia.
have t_in := t_place p0_few p1_few p2_few; have {}known_t a := known_t a t_in.
have far_along a : (a < d)%N -> Z.le (reach error gap widest) (Z.abs (Z.sub (along_axis s a) (along_axis t a))) -> good (Image i j k l m).
  move=> ad far_st; apply: (good_along ad) => //; rewrite sep_st //.
  apply: at_least_away (difference_is_known (known_s a ad) (known_t a ad)) _.
  by rewrite reach_is in far_st; clear -far_st; lia.
have ad0 : (0 < d)%N by case: (d). have ad1 : (1 < d)%N by case: (d).
have [t_near|] := boolP (near_cell error gap widest x0 x1 y0 y1 z0 z1 t); last first.
  rewrite negbK /beyond => /or4P[out|out|out|/or3P[out|out|out]];
    [apply: (far_along 0%N)|apply: (far_along 0%N)|apply: (far_along 1%N)|apply: (far_along 1%N)| |] => //;
    rewrite /along_axis; try by clear -out sx0 sx1 sy0 sy1; lia.
  - case: in_plane => [ad2|[_ same]]; first by apply: (far_along 2%N) => //; rewrite /along_axis; clear -out sz0 sz1; lia.
    by exfalso; clear -out same sz0 sz1 reach0 e20; lia.
  case: in_plane => [ad2|[_ same]]; first by apply: (far_along 2%N) => //; rewrite /along_axis; clear -out sz0 sz1; lia.
  by exfalso; clear -out same sz0 sz1 reach0 e20; lia.
have s_near : near_cell error gap widest x0 x1 y0 y1 z0 z1 s.
  by rewrite /near_cell /beyond; clear -sx0 sx1 sy0 sy1 sz0 sz1 reach0 e20; lia.
have st : s != t.
  apply/negP => /eqP st; move: ne; have ij : i = j by apply: Nat2Z.inj; rewrite -(proj1 name_s) -name_t st.
  have [k0 l0 m0] : [/\ - (w i).1.1 = k - (w i).1.1, - (w i).1.2 = l - (w i).1.2 & - (w i).2 = m - (w i).2].
    by move: periods_s; rewrite st periods_t => -[-> -> ->].
  have zero u v : - u = v - u -> v = Z0 :> Z by clear; lia.
  by rewrite ij eqxx (zero _ _ k0) (zero _ _ l0) (zero _ _ m0).
have known_names u v : Z.sub (v - u) (- u) = v /\ Z.sub (- u) (v - u) = Z.opp v by clear; lia.
have far_good : far_seen error gap s t -> good (Image i j k l m).
  move=> enough; left; rewrite /apart_by /apart distance_by_separations.
  move: enough; rewrite /far_seen size_s size_t -(real_le F) !(real_plus, real_times) -!expr2 => /le_trans; apply.
  have below a : (a < d)%N -> real (surely (Z.sub (along_axis s a) (along_axis t a)) (Z.mul 2 e2)) ^+ 2
      <= separation d n y i j k l m a * separation d n y i j k l m a.
    by move=> ad; rewrite -expr2 sep_st; apply: surely_below; apply: difference_is_known; [apply: known_s|apply: known_t].
  case: in_plane => [ad2|[flat same]].
    have -> : over d (fun a => separation d n y i j k l m a * separation d n y i j k l m a)
      = separation d n y i j k l m 0 * separation d n y i j k l m 0 + separation d n y i j k l m 1 * separation d n y i j k l m 1
        + separation d n y i j k l m 2 * separation d n y i j k l m 2 by case: (d) ad2 => // _; rewrite /over /= addr0 addrA.
    by apply: ler_add; [apply: ler_add|]; [apply: (below 0%N)|apply: (below 1%N)|apply: (below 2%N)].
  have -> : over d (fun a => separation d n y i j k l m a * separation d n y i j k l m a)
    = separation d n y i j k l m 0 * separation d n y i j k l m 0 + separation d n y i j k l m 1 * separation d n y i j k l m 1 + 0.
    by rewrite flat /over /= addrA.
  apply: ler_add; first by apply: ler_add; [apply: (below 0%N)|apply: (below 1%N)].
  have -> : surely (Z.sub (applicate s) (applicate t)) (Z.mul 2 (blur error)) = Z0.
    by rewrite same /surely -/e2; clear -e20; lia.
  by rewrite real_zero expr0n.
have turned_far : far_seen error gap t s = far_seen error gap s t.
  have surely_opp u v e : surely (Z.sub u v) e = surely (Z.sub v u) e by rewrite /surely; clear; lia.
  by rewrite /far_seen (surely_opp (abscissa t)) (surely_opp (ordinate t)) (surely_opp (applicate t)) (Z.add_comm (size_of t)).
have [k_st k_ts] := known_names (w i).1.1 k; have [l_st l_ts] := known_names (w i).1.2 l; have [m_st m_ts] := known_names (w i).2 m.
have pair_st : pair_of s t = Image i j k l m.
  by rewrite /pair_of /periods_between (proj1 name_s) name_t periods_s periods_t !Nat2Z.id; congr Image.
have pair_ts : pair_of t s = Image j i (Z.opp k) (Z.opp l) (Z.opp m).
  by rewrite /pair_of /periods_between (proj1 name_s) name_t periods_s periods_t !Nat2Z.id; congr Image.
have settle u v i' j' k' l' m' : settled_seen d n contacts radius x error gap [seq code c | c <- contacts] u v -> central u || central v ->
    pair_of u v = Image i' j' k' l' m' -> number u = Z.of_nat i' -> number v = Z.of_nat j' ->
    (far_seen error gap u v -> good (Image i' j' k' l' m')) -> ~~ listed contacts (Image i' j' k' l' m') ->
    good (Image i' j' k' l' m').
  rewrite /settled_seen => + one pair_uv nu nv close_far unlisted'; rewrite one pair_uv; case: ifP => [/close_far //|_].
  have [-> -> ->] : [/\ (periods_between u v).1.1 = k', (periods_between u v).1.2 = l' & (periods_between u v).2 = m'].
    by case: pair_uv.
  rewrite nu nv joined_is_listed (negPf unlisted'); case: ifP => // stay far0; right; split=> //; exact: held_pairs_are_apart.
have turn : (far_seen error gap t s -> good (Image j i (Z.opp k) (Z.opp l) (Z.opp m))) by rewrite turned_far => /far_good /turn_good.
have unlisted' : ~~ listed contacts (Image j i (Z.opp k) (Z.opp l) (Z.opp m)) by rewrite turned_is_listed.
have total_order : total left_of by move=> u v; rewrite /left_of; clear; lia.
have := sweep_covers (sort_sorted total_order _) swept; move=> /(_ s t).
rewrite !mem_sort !mem_filter s_near s_place t_near t_in => /(_ isT isT st).
case=> [[settled_st|]|[settled_ts|]].
- by apply: (settle _ _ _ _ _ _ _ settled_st _ pair_st (proj1 name_s) name_t far_good unlisted); rewrite (proj2 name_s).
- by rewrite /out_of_reach /beyond => out; apply: (far_along 0%N) => //; rewrite /along_axis; clear -out; lia.
- apply: turned_is_good; apply: (settle _ _ _ _ _ _ _ settled_ts _ pair_ts name_t (proj1 name_s) turn unlisted').
  by rewrite (proj2 name_s) orbT.
by rewrite /out_of_reach /beyond => out; apply: (far_along 0%N) => //; rewrite /along_axis; clear -out; lia.
Qed.
End Apart.

Section Others.
Variables (F : realFieldType) (d : dimension) (n : nat) (walls periodic : seq bool) (contacts : seq contact).
Variables (radius place x : nat -> Z).
Variables (error gap widest : Z) (y : nat -> F).
Hypothesis close : forall k, `|y k - real (x k)| <= real error.
Let R (i : nat) : F := real (radius i).
Let P (k : nat) : F := real (place k).
Hypothesis there : forall k, held contacts k -> y k = P k.

(** Between grains that cannot move there is no overlap; other gaps exceed the stated one. *)
Theorem other_grains_are_apart c : gaps_check d n walls periodic contacts radius place x error gap widest ->
  in_the_packing d n walls periodic c -> ~~ holds c -> ~~ listed contacts c ->
  apart d n R P y (if immobile d n contacts c then 0 else real gap) c.
Proof.
case/and5P=> /Z.ltb_lt g0 /Z.leb_le e0 /allP sizes pairs /andP[equal /allP known] present pair unlisted.
have sizes' i : (i < n)%N -> Z.le 0 (radius i) /\ Z.le (radius i) widest.
  by move=> i_n; have := sizes i; rewrite mem_iota => /(_ i_n)/andP[/Z.leb_le ? /Z.leb_le].
suff [far|[-> //]] : apart d n R P y (real gap) c \/ immobile d n contacts c /\ apart d n R P y 0 c.
  case: ifP => // _; have g1 : 0 <= real gap :> F by rewrite -(real_zero F) real_le; lia.
  have R0 i : (i < n)%N -> 0 <= R i by move=> /sizes'[i0 _]; rewrite -(real_zero F) real_le; lia.
  move: present far; rewrite /apart; case: (c) => [i j k l m /and5P[/R0 i0 /R0 j0 _ _ _]|i a _|i a _|k _] //; apply: le_trans.
  - by rewrite ler_pexpn2r ?nnegrE ?addr_ge0 // ler_add2l.
  - by rewrite ler_add2l.
  by rewrite ler_add2l.
have of_settled b : settled d n contacts radius x error gap b -> ~~ listed contacts b ->
    apart d n R P y (real gap) b \/ immobile d n contacts b /\ apart d n R P y 0 b.
  rewrite /settled; case: ifP => [/(far_is_apart P close)|_]; first by left.
  case: ifP => // _; case: ifP => // stay far0 _; right; split=> //; exact: (held_pairs_are_apart there equal).
have in_n i : (i < n)%N -> i \in iota 0 n by rewrite mem_iota.
have in_d a : (a < d)%N -> a \in iota 0 d by rewrite mem_iota.
case: c present pair unlisted => [i j k l m|i a|i a|k] // present _ unlisted.
- exact: (pairs_are_apart close there g0 e0 sizes' equal pairs present).
- case/and3P: present => /in_n/known/allP axes_known /in_d/axes_known/andP[ok _] there_is; move: ok.
  by rewrite /settled_wall there_is => ok; apply: of_settled ok unlisted.
case/and3P: present => /in_n/known/allP axes_known /in_d/axes_known/andP[_ ok] there_is; move: ok.
by rewrite /settled_wall there_is => ok; apply: of_settled ok unlisted.
Qed.
End Others.
Print Assumptions other_grains_are_apart.
