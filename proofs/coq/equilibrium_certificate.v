(** The certificate of an equilibrium in a box or a cell, and the check that Coq evaluates.

    It adds to that of the vertex: approximate forces under the finite load and under the infinitesimal one, in
    fractions of a force unit, the intervals that are claimed, the contacts whose finite force is exactly 0 with the
    degrees of freedom that prove it (K7), and the smallest gap of all other grains. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify ring.
From Isostat Require Import certificate contact_certificate dense_rows integers_in_a_field shifted_factor max_norm box
  box_vertex box_certificate box_forces box_gaps box_minimum.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

Record force_solution := ForceSolution {
  load : seq Z;      (* on each degree of freedom, in units of force *)
  fraction : Z;
  quotients : seq Z; (* fraction * force / length of contact, rounded *)
  slack : Z          (* what they may be off *)
}.

Record force_claim := ForceClaim {
  solution :> force_solution;
  low : seq Z;       (* the claimed intervals of the forces, in units of force *)
  high : seq Z
}.

Record equilibrium_certificate := EquilibriumCertificate {
  vertex : vertex_certificate;
  finite : force_claim;
  infinitesimal : force_claim;
  zeros : seq bool;  (* contacts without finite force *)
  unloaded : seq bool; (* degrees of freedom that no other contact touches *)
  gap : Z
}.

Section Check.
Variable e : equilibrium_certificate.
Let v := vertex e.
Let d := lies_in v.
Let n := disks v.
Let N := (coordinates_of d n)%N.
Local Open Scope Z_scope.

Definition rows_at_the_refined_one (c : contact) : seq (nat * Z) := gradient d n (fine_weight v) (refined_at v) c.
Definition contributions (T : Type) (rows : contact -> seq (nat * T)) (value : T -> Z -> Z) (p : force_solution) : seq (nat * Z) :=
  flatten [seq [seq (t.1, value t.2 cg.2) | t <- rows cg.1] | cg <- zip (contacts v) (quotients p)].
Definition residual (p : force_solution) : seq Z :=
  put_all (contributions rows_at_the_refined_one Z.mul p) [seq fraction p * z | z <- load p].
Definition blur (p : force_solution) : seq Z := dense N (contributions (entry_changes d n) (fun m g => Z.of_nat m * Z.abs g) p).
Definition nearly_balanced (p : force_solution) : bool :=
  let res := residual p in let bl := blur p in
  [&& size (load p) == N, size (quotients p) == N, 0 <? fraction p, 0 <=? slack p
    & all (fun k => Z.abs (nth 0 res k) + error v * nth 0 bl k <=? fine_stiffness v * slack p) (iota 0 N)].

Definition scale_of (l : nat) : Z := scale (fine_weight v) (fine_radius v) (contact_at (contacts v) l).
(** The interval of force l holds what the quotient proves, and is positive. *)
Definition interval_claimed (p : force_claim) (l : nat) : bool :=
  [&& 0 <? nth 0 (low p) l, fraction p * nth 0 (low p) l <=? scale_of l * (nth 0 (quotients p) l - slack p)
    & scale_of l * (nth 0 (quotients p) l + slack p) <=? fraction p * nth 0 (high p) l].

(** Row l holds a coordinate: its force has any sign. *)
Definition held_at (l : nat) : bool := holds (contact_at (contacts v) l).
Definition zero_at (l : nat) : bool := nth false (zeros e) l.
(** Two lists of flags: [free] has as many as [mask], less [more]; contacts without a flag do not touch [free]. *)
Definition counted (more : nat) (mask free : seq bool) : bool :=
  [&& size mask == N, size free == N, count id mask == (count id free + more)%N
    & all (fun l => nth false mask l
        || all (fun k => ~~ nth false free k) (coordinates d n (contact_at (contacts v) l))) (iota 0 N)].
Definition free_of (p : seq Z) (free : seq bool) : bool :=
  all (fun k => ~~ nth false free k || (nth 0 p k =? 0)) (iota 0 N).
Definition zeros_are_structural : bool := counted 0 (zeros e) (unloaded e) && free_of (load (finite e)) (unloaded e).
Definition forces_claimed : bool :=
  all (fun l => if held_at l then ~~ zero_at l else
    interval_claimed (if zero_at l then infinitesimal e else finite e) l) (iota 0 N).

(** Along a periodic axis one row holds a disk, and no wall bears a force. *)
Definition one_pin (a : nat) : bool :=
  ~~ repeats d (periodic v) a || let first := find (pins d n a) (contacts v) in
    [&& ~~ nth false (walls v) a, ~~ nth false (walls v) (d + a)
      & all (fun l => (l == first) || ~~ pins d n a (contact_at (contacts v) l)) (iota 0 N)].

Definition widest : Z := foldr Z.max 0 [seq fine_radius v i | i <- iota 0 n].
Definition equilibrium_check : bool :=
  [&& vertex_check v, nearly_balanced (finite e), nearly_balanced (infinitesimal e), zeros_are_structural
    & [&& forces_claimed, all one_pin (iota 0 d)
      & gaps_check d n (walls v) (periodic v) (contacts v) (fine_radius v) (fine_place v) (refined_at v) (error v) (gap e) widest]].
End Check.

Local Open Scope ring_scope.

Section Correct.
Variables (F : archiFieldType) (e : equilibrium_certificate).
Let v := vertex e.
Let d := lies_in v.
Let n := disks v.
Let N := (coordinates_of d n)%N.
Let q1 : 'cV[F]_N := refined_configuration F v.
Let q0 : 'cV[F]_N := stored_configuration F v.
Let w : F := real (fine_weight v).
Let A := derivative w (contacts v) : 'cV[F]_N -> 'M[F]_N.

Hypothesis check : equilibrium_check e.
Let vertex_ok : vertex_check v. Proof. by case/and5P: check. Qed.
Let posed : well_posed v. Proof. by case/and5P: vertex_ok. Qed.
Let size_contacts : size (contacts v) = N. Proof. by case/and5P: posed => _ _ /andP[/eqP]. Qed.

Lemma derivative_at_the_refined_one (l k : 'I_N) : A q1 l k
  = real (\sum_(t <- rows_at_the_refined_one e (contact_at (contacts v) l) | t.1 == k) t.2).
Proof.
rewrite mxE (gradient_ext _ _ _ _ (at_refined _ posed)) (gradient_morphism (real_rmorphism F)) big_map.
by rewrite rmorph_sum.
Qed.

Lemma contributions_sum (T : Type) (rows : contact -> seq (nat * T)) (value : T -> Z -> Z) p k : size (quotients p) = N ->
  \sum_(t <- contributions e rows value p | t.1 == k) t.2
    = \sum_(l < N) \sum_(t <- rows (contact_at (contacts v) l) | t.1 == k) value t.2 (nth 0 (quotients p) l).
Proof.
move=> sG; rewrite /contributions big_flatten big_map (big_nth (Lower 0 0, 0)) big_mkord size_zip size_contacts sG minnn.
by apply: eq_bigr => l _; rewrite nth_zip ?sG ?size_contacts // big_map.
Qed.

Definition load_vector (p : force_solution) : 'cV[F]_N := \col_k real (nth 0 (load p) k).
Definition quotient_vector (p : force_solution) : 'cV[F]_N := \col_l real (nth 0 (quotients p) l).

Let blur_is_sum p (k : 'I_N) : size (quotients p) = N ->
  \sum_(l < N) real (error v) * (\sum_(t <- entry_changes d n (contact_at (contacts v) l) | t.1 == k) t.2)%:R
      * `|quotient_vector p l 0| = real (error v) * real (nth 0 (blur e p) k).
Proof.
move=> sG; rewrite dense_entry // contributions_sum // rmorph_sum mulr_sumr; apply: eq_bigr => l _.
rewrite -mulrA; congr (_ * _); rewrite mxE real_abs natr_sum mulr_suml rmorph_sum; apply: eq_bigr => t _.
by rewrite -real_of_nat -real_times.
Qed.

Let residual_is_sum p (k : 'I_N) : size (load p) = N -> size (quotients p) = N ->
  real (fraction p) * load_vector p k 0 + ((A q1)^T *m quotient_vector p) k 0 = real (nth 0 (residual e p) k).
Proof.
move=> sL sG; have [_ entry] := put_all_entry (contributions e (rows_at_the_refined_one e) Z.mul p) [seq fraction p * z | z <- load p] k.
rewrite /residual [nth _ _ _]entry ?size_map ?sL // (nth_map 0) ?sL // contributions_sum // rmorphD rmorphM !mxE.
congr (_ + _); rewrite rmorph_sum; apply: eq_bigr => l _.
by rewrite [_^T _ _]mxE [quotient_vector p _ _]mxE derivative_at_the_refined_one -rmorphM mulr_suml.
Qed.

Let w_gt0 : 0 < w.
Proof. by case/and5P: posed => _ _ _ _ /and3P[]; rewrite -(real_zero F) real_lt /fine_weight; nia. Qed.
Let w1 : w != 0 := lt0r_neq0 w_gt0.
Let b0 : 0 < real (fine_stiffness v) :> F.
Proof. by case/and5P: posed => _ _ _ _ /and3P[]; rewrite -(real_zero F) real_lt /fine_stiffness; nia. Qed.
Let scales l : scale 1 (radius F v) (contact_at (contacts v) l) != 0 := lt0r_neq0 (scales_are_positive F posed l).

Lemma scale_is_positive l : 0 < real (scale_of e l) :> F.
Proof.
have : 0 < scale w (radius F v) (contact_at (contacts v) l).
  by have := scales_are_positive F posed l; case: (contact_at _ _) => //= *; apply: w_gt0.
by congr (0 < _); rewrite /scale_of; case: (contact_at _ _) => //= i j _ _ _; rewrite real_plus.
Qed.

(** What a solution proves of the forces at the true vertex q. *)
Definition encloses (p : force_solution) (f : 'cV[F]_N) : Prop := forall l : 'I_N,
  real (scale_of e l) * real (nth 0 (quotients p) l - slack p) <= real (fraction p) * f l 0
    <= real (scale_of e l) * real (nth 0 (quotients p) l + slack p).

Lemma forces_are_found (p : force_solution) (q : 'cV[F]_N) : nearly_balanced e p ->
  norm (q - q1) <= real (error v) -> norm (q - q0) <= real (zoom v * ball v) ->
  normals (radius F v) (contacts v) q \in unitmx ->
  exists f, [/\ balanced (radius F v) (contacts v) q (load_vector p) f,
    forall f', balanced (radius F v) (contacts v) q (load_vector p) f' -> f' = f & encloses p f].
Proof.
case/and5P=> /eqP sL /eqP sG t0 c0 /allP res near inside unit.
have inverse x := forces_follow_from_residuals posed x vertex_ok inside.
have slack0 : 0 <= real (slack p) :> F by rewrite -(real_zero F) real_le.
have [] := forces_are_enclosed w1 scales unit b0 inverse near (load := load_vector p) (G := quotient_vector p)
  (fraction := real (fraction p)) slack0.
  move=> k; rewrite blur_is_sum // residual_is_sum // real_abs -real_times.
  have := res (k : nat); rewrite mem_iota ltn_ord => /(_ isT); by rewrite -(real_le F) real_plus !real_times.
move=> f [bal alone close]; exists f; split=> // l.
have SE : scale w (radius F v) (contact_at (contacts v) l) = real (scale_of e l).
  by rewrite /scale_of; case: (contact_at _ _) => //= i j _ _ _; rewrite real_plus.
have := close l; rewrite SE (gtr0_norm (scale_is_positive l)) mxE ler_distl -mulrBr -mulrDr.
by rewrite real_minus real_plus.
Qed.

Lemma forces_are_claimed (p : force_claim) (f : 'cV[F]_N) (l : 'I_N) : nearly_balanced e p -> encloses p f ->
  interval_claimed e p l -> [/\ 0 < f l 0, real (nth 0 (low p) l) <= f l 0 & f l 0 <= real (nth 0 (high p) l)].
Proof.
case/and5P=> _ _ t0 _ _ /(_ l)/andP[above below] /and3P[low0 low_ok high_ok].
have t1 : 0 < real (fraction p) :> F by rewrite -(real_zero F) real_lt.
have low_f : real (nth 0 (low p) l) <= f l 0.
  by rewrite -(ler_pmul2l t1); apply: le_trans above; rewrite -!real_times real_le.
split=> //; first by apply: lt_le_trans low_f; rewrite -(real_zero F) real_lt.
by rewrite -(ler_pmul2l t1); apply: le_trans below _; rewrite -!real_times real_le.
Qed.

Definition flagged (mask : seq bool) : {set 'I_N} := [set k : 'I_N | nth false mask k].
Lemma counted_sets more mask free : counted e more mask free -> #|flagged mask| = (#|flagged free| + more)%N /\
  forall k l : 'I_N, k \in flagged free -> l \notin flagged mask ->
    (k : nat) \notin coordinates d n (contact_at (contacts v) l).
Proof.
case/and4P=> /eqP sM /eqP sU /eqP same /allP apart.
have card (m : seq bool) : size m = N -> #|flagged m| = count id m.
  move=> sm; rewrite cardsE cardE size_filter -(count_map (fun k : 'I_N => nth false m k) id) -[in RHS](mkseq_nth false m).
  by rewrite sm /mkseq -val_enum_ord -map_comp enumT.
split=> [|k m]; first by rewrite !card.
rewrite !inE => uk /negPf nz; have := apart (m : nat); rewrite mem_iota ltn_ord nz => /(_ isT)/allP away.
by apply/negP => /away; rewrite uk.
Qed.

Lemma counted_size more mask free : counted e more mask free -> size mask = N.
Proof. by case/and4P=> /eqP. Qed.

Lemma free_of_load p free : free_of e (load p) free -> forall k, k \in flagged free -> load_vector p k 0 = 0.
Proof.
move=> /allP zero k; rewrite inE => kf; have := zero (k : nat).
by rewrite mem_iota ltn_ord kf => /(_ isT)/Z.eqb_eq none; rewrite mxE none real_zero.
Qed.

Let structural : zeros_are_structural e. Proof. by case/and5P: check. Qed.
Let zeros_counted : #|flagged (unloaded e)| = #|flagged (zeros e)|.
Proof. by case/andP: structural => /counted_sets[-> _]; rewrite addn0. Qed.
Let zeros_apart (k l : 'I_N) : k \in flagged (unloaded e) -> l \notin flagged (zeros e) ->
  (k : nat) \notin coordinates d n (contact_at (contacts v) l).
Proof. by case/andP: structural => /counted_sets[_ apart] _; apply: apart. Qed.
Let zeros_unloaded : forall k, k \in flagged (unloaded e) -> load_vector (finite e) k 0 = 0.
Proof. by case/andP: structural => _ /free_of_load. Qed.

Lemma zeros_are_zero (q f : 'cV[F]_N) : normals (radius F v) (contacts v) q \in unitmx ->
  balanced (radius F v) (contacts v) q (load_vector (finite e)) f -> forall l : 'I_N, zero_at e l -> f l 0 = 0.
Proof.
by move=> unit bal l zl; apply: (structural_zeros unit bal zeros_counted zeros_unloaded zeros_apart); rewrite inE.
Qed.

(** What is said of a configuration: the statement of the theorem, in full. *)
Definition is_the_equilibrium (q : 'cV[F]_N) : Prop :=
  [/\ forall l : 'I_N, in_the_packing d n (walls v) (periodic v) (contact_at (contacts v) l)
       /\ touch d n (radius F v) (place F v) (at_ q) (contact_at (contacts v) l),
     normals (radius F v) (contacts v) q \in unitmx,
     forall c, in_the_packing d n (walls v) (periodic v) c -> ~~ holds c -> ~~ listed (contacts v) c ->
       apart d n (radius F v) (place F v) (at_ q) (if immobile d n (contacts v) c then 0 else real (gap e)) c,
     exists f : 'cV[F]_N, [/\ balanced (radius F v) (contacts v) q (load_vector (finite e)) f,
       forall f', balanced (radius F v) (contacts v) q (load_vector (finite e)) f' -> f' = f
       & forall l : 'I_N, ~~ held_at e l -> if zero_at e l then f l 0 = 0 else
           [/\ 0 < f l 0, real (nth 0 (low (finite e)) l) <= f l 0 & f l 0 <= real (nth 0 (high (finite e)) l)]]
   & exists f : 'cV[F]_N, [/\ balanced (radius F v) (contacts v) q (load_vector (infinitesimal e)) f,
       forall f', balanced (radius F v) (contacts v) q (load_vector (infinitesimal e)) f' -> f' = f
       & forall l : 'I_N, zero_at e l ->
           [/\ 0 < f l 0, real (nth 0 (low (infinitesimal e)) l) <= f l 0
             & f l 0 <= real (nth 0 (high (infinitesimal e)) l)]]].

Let near_the_refined_one (q : 'cV[F]_N) k : norm (q - q1) <= real (error v) ->
  `|at_ q k - real (refined_at v k)| <= real (error v).
Proof. by rewrite -(at_refined F posed) -at_sub => near; apply: le_trans near; apply: at_norm. Qed.

(** ... and that it is the one near the stored configuration, and a strict minimum. *)
Definition is_certified (q : 'cV[F]_N) : Prop :=
  [/\ norm (q - q1) <= real (error v), norm (q - q0) <= real (distance v), is_the_equilibrium q,
     strict_minimum (radius F v) (place F v) (contacts v) (load_vector (finite e)) (load_vector (infinitesimal e)) q
   & forall q' : 'cV[F]_N, norm (q' - q0) <= real (zoom v * ball v) ->
       (forall l : 'I_N, touch d n (radius F v) (place F v) (at_ q') (contact_at (contacts v) l)) -> q' = q].
Definition certified_equilibrium : Prop := exists q, is_certified q.

Let inside (q : 'cV[F]_N) : norm (q - q1) <= real (error v) -> norm (q - q0) <= real (distance v) ->
  norm (q - q0) <= real (zoom v * ball v).
Proof.
move=> near close; apply: le_trans close _; have /and5P[_ _ /andP[ball_ok _] _ _] := vertex_ok.
by rewrite -(real_le F) real_plus in ball_ok; apply: le_trans ball_ok; rewrite ler_addl (le_trans (norm_ge0 _) near).
Qed.
Lemma inside_the_ball q : is_certified q -> norm (q - q0) <= real (zoom v * ball v).
Proof. by case=> near close _ _ _; apply: inside. Qed.

Theorem one_equilibrium : complete F -> certified_equilibrium.
Proof.
move=> full; have [q [near close closed unit alone]] := one_vertex posed full vertex_ok.
have inside_q := inside near close.
have /and5P[_ bal bal_small _ /and3P[/allP claims _ gaps_ok]] := check.
have claimed (l : 'I_N) : if held_at e l then ~~ zero_at e l
    else interval_claimed e (if zero_at e l then infinitesimal e else finite e) l.
  by apply: claims; rewrite mem_iota ltn_ord.
have touching (l : 'I_N) : zero_at e l -> ~~ held_at e l by have := claimed l; case: ifP => // _ /negPf ->.
have [f [fb fu fl]] := forces_are_found bal near inside_q unit.
have [g [gb gu gl]] := forces_are_found bal_small near inside_q unit.
have zero := zeros_are_zero unit fb.
have pushing (l : 'I_N) : ~~ zero_at e l -> ~~ held_at e l -> [/\ 0 < f l 0, real (nth 0 (low (finite e)) l) <= f l 0
    & f l 0 <= real (nth 0 (high (finite e)) l)] by move=> /negPf zl /negPf hl; have := claimed l; rewrite zl hl => /(forces_are_claimed bal fl).
have pushing_small (l : 'I_N) : zero_at e l -> [/\ 0 < g l 0, real (nth 0 (low (infinitesimal e)) l) <= g l 0
    & g l 0 <= real (nth 0 (high (infinitesimal e)) l)] by move=> zl; have := claimed l; rewrite zl (negPf (touching l zl)) => /(forces_are_claimed bal_small gl).
exists q; split=> //.
- split=> //.
  + move=> l; split; last exact: closed.
    have /and5P[_ _ /andP[/eqP sC /all_nthP rows] _ _] := posed.
    by apply: rows; rewrite sC.
  + move=> c formed pair unlisted; apply: other_grains_are_apart gaps_ok formed pair unlisted => k.
      exact: near_the_refined_one.
    case/(has_nthP (Lower 0 0)) => l lN here; rewrite size_contacts in lN; have := closed (Ordinal lN).
    by rewrite /contact_at /=; case: (nth _ _ _) here => //= m /eqP ->.
  + by exists f; split=> // l; case: ifPn => [/zero|/pushing].
  by exists g.
- have [regular _] := gaps_follow_displacements posed 0 vertex_ok inside_q.
  apply: (equilibrium_is_a_strict_minimum w_gt0 (scales_are_positive F posed) _ b0 _ zeros_counted zeros_unloaded zeros_apart fb gb) => //.
  + exact/(gaps_vanish _ _ _ _ w1).
  + by move=> x; have [] := gaps_follow_displacements posed x vertex_ok inside_q.
  + by move=> l; rewrite inE; apply: zero.
  + by move=> l; rewrite inE => zl /(pushing l zl)[].
  by move=> l; rewrite inE => /pushing_small[].
Qed.

(** Loads that cancel along a periodic axis, and forces that balance them: what holds a disk there bears nothing. The
    forces are those of contacts alone, whichever disk is held. *)
Definition pins_bear_nothing (q : 'cV[F]_N) : Prop :=
  forall (a : nat) (any f : 'cV[F]_N), repeats d (periodic v) a -> balanced (radius F v) (contacts v) q any f ->
    \sum_(i < n) at_ any (i * d + a) = 0 -> forall l : 'I_N, pins d n a (contact_at (contacts v) l) -> f l 0 = 0.

Lemma no_pin_bears_anything q : pins_bear_nothing q.
Proof.
move=> a any f along bal cancel l pinned; have /and5P[_ _ _ _ /and3P[_ /allP pin _]] := check.
have /andP[ad _] := along.
have : one_pin e a by apply: pin; rewrite mem_iota.
rewrite /one_pin along => /and3P[low high /allP alone].
apply: (one_pin_bears_nothing bal ad cancel _ _ pinned) => [m|m m' pm pm'].
  have /and5P[_ _ /andP[/eqP sC /all_nthP rows] _ _] := posed.
  have := rows (Lower 0 0) m; rewrite sC => /(_ (ltn_ord m)); rewrite /contact_at.
  case: (nth _ _ m) => [i j p r r' /and5P[i_n j_n _ _ _]|i z /and3P[i_n zd there]|i z /and3P[i_n zd there]|//];
    rewrite /blind i_n ?j_n ?zd //=.
    by apply: contraTneq there => ->.
  by apply: contraTneq there => ->.
have first k : pins d n a (contact_at (contacts v) (k : 'I_N)) -> (k : nat) = find (pins d n a) (contacts v).
  by move=> pk; have := alone (k : nat); rewrite mem_iota ltn_ord pk orbF => /(_ isT)/eqP.
by apply: val_inj; rewrite /= (first _ pm) (first _ pm').
Qed.
End Correct.
Print Assumptions no_pin_bears_anything.
Print Assumptions one_equilibrium.
