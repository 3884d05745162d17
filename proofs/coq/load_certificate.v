(** The certificate of the supported interval of one stress, and the check that Coq evaluates (K10).

    It adds to that of the equilibrium the load per unit of the stress, with approximate forces, and either end of the
    interval: the contact whose force vanishes there, and those whose forces vanish with it, by counting. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify ring.
From Isostat Require Import contact_certificate integers_in_a_field max_norm box box_certificate box_forces box_minimum
  box_load equilibrium_certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

Record load_end := LoadEnd {
  opens : option nat; (* the contact whose force vanishes there; None: there is no end *)
  mute : seq bool;    (* contacts without force there; without an end: those whose force does not change *)
  free : seq bool;    (* degrees of freedom that no other contact touches *)
  near : Z;           (* the end is not nearer than this stress, and not further than that *)
  far : Z
}.

Record load_certificate := LoadCertificate {
  equilibrium : equilibrium_certificate;
  rate : force_solution; (* the load per unit of stress *)
  stress : Z;            (* the present one *)
  lower_end : load_end;
  upper_end : load_end
}.

Section Check.
Variable c : load_certificate.
Let e := equilibrium c.
Let v := vertex e.
Let n := disks v.
Let N := (coordinates_of (lies_in v) n)%N.
Local Open Scope Z_scope.

(** How fast a quotient falls, and how far ahead a stress is, when the stress grows or, [up = false], becomes less. *)
Definition signed (up : bool) (z : Z) : Z := if up then z else - z.
Definition fall (up : bool) (l : nat) : Z := - signed up (nth 0 (quotients (rate c)) l).
Definition ahead (up : bool) (s : Z) : Z := signed up (s - stress c).
Definition quotient (l : nat) : Z := nth 0 (quotients (finite e)) l.
Definition uncertain (a b : Z) : Z := Z.abs a * slack (rate c) + Z.abs b * slack (finite e) + slack (finite e) * slack (rate c).

(** Force l is still positive where that of m vanishes. *)
Definition outlasts (up : bool) (m l : nat) : bool :=
  uncertain (quotient l) (fall up m) + uncertain (quotient m) (fall up l)
    <? quotient l * fall up m - quotient m * fall up l.
Definition vanishes_between (up : bool) (x : load_end) (m : nat) : bool :=
  ((ahead up (near x) * fall up m + Z.abs (ahead up (near x)) * slack (rate c)) * fraction (finite e)
    <=? (quotient m - slack (finite e)) * fraction (rate c))
  && ((quotient m + slack (finite e)) * fraction (rate c)
    <=? (ahead up (far x) * fall up m - Z.abs (ahead up (far x)) * slack (rate c)) * fraction (finite e)).

Definition end_check (up : bool) (x : load_end) : bool :=
  free_of e (load (rate c)) (free x) &&
  if opens x is Some m then
    [&& counted e 1 (mute x) (free x), free_of e (load (finite e)) (free x), nth false (mute x) m && ~~ (zero_at e m || held_at e m),
      slack (rate c) <? fall up m, vanishes_between up x m
      & all (fun l => nth false (mute x) l || held_at e l || outlasts up m l) (iota 0 N)]
  else counted e 0 (mute x) (free x) && all (fun l => nth false (mute x) l || held_at e l || (fall up l + slack (rate c) <? 0)) (iota 0 N).

Definition load_check : bool :=
  [&& equilibrium_check e, nearly_balanced e (rate c), end_check false (lower_end c) & end_check true (upper_end c)].
End Check.

Local Open Scope ring_scope.

Section Correct.
Variables (F : archiFieldType) (c : load_certificate).
Let e := equilibrium c.
Let v := vertex e.
Let n := disks v.
Let N := (coordinates_of (lies_in v) n)%N.

(** The load when the stress is [s], and which of two stresses comes first. *)
Definition load_at (s : F) : 'cV[F]_N := load_vector F e (finite e) + (s - real (stress c)) *: load_vector F e (rate c).
Definition first (up : bool) (s t : F) : Prop := if up then s <= t else t <= s.

(** What is said of an end of the interval. Contacts that push bear the load up to the stress [t] and not beyond. At t
    the force of the contact that opens is 0, with those of [mute]; all others push. *)
Definition is_the_end (q : 'cV[F]_N) (up : bool) (x : load_end) : Prop :=
  let now : F := real (stress c) in
  if opens x is Some m then exists t,
    [/\ first up (real (near x)) t, first up t (real (far x)),
       forall s, first up now s -> borne (radius F v) (contacts v) q (load_at s) <-> first up s t
     & exists2 f, balanced (radius F v) (contacts v) q (load_at t) f
       & forall l : 'I_N, ~~ held_at e l -> if (l == m :> nat) || nth false (mute x) l then f l 0 = 0 else 0 < f l 0]
  else forall s, first up now s -> borne (radius F v) (contacts v) q (load_at s).

Let sign (up : bool) : F := if up then 1 else -1.
Let firstE up s t : first up s t <-> sign up * s <= sign up * t.
Proof. by rewrite /first /sign; case: up; rewrite ?mul1r ?mulN1r ?ler_opp2. Qed.
Let sign_sign up : sign up * sign up = 1.
Proof. by rewrite /sign; case: up; rewrite ?mulrNN mulr1. Qed.
Let real_signed up z : real (signed up z) = sign up * real z :> F.
Proof. by rewrite /signed /sign; case: up; rewrite ?mul1r // mulN1r rmorphN. Qed.

Let load_ahead up s : load_at s
  = load_vector F e (finite e) + (sign up * (s - real (stress c))) *: (sign up *: load_vector F e (rate c)).
Proof. by rewrite scalerA mulrAC sign_sign mul1r. Qed.

Section End.
Variables (q f u : 'cV[F]_N) (up : bool) (x : load_end).
Hypothesis equilibrium_ok : equilibrium_check e.
Hypothesis regular : normals (radius F v) (contacts v) q \in unitmx.
Hypothesis bal : balanced (radius F v) (contacts v) q (load_vector F e (finite e)) f.
Hypothesis rate_bal : balanced (radius F v) (contacts v) q (load_vector F e (rate c)) u.
Hypothesis f_known : encloses (finite e) f.
Hypothesis u_known : encloses (rate c) u.
Hypothesis positive : forall l : 'I_N, ~~ zero_at e l -> ~~ held_at e l -> 0 < f l 0.
Hypothesis pushing : forall l : 'I_N, ~~ held_at e l -> 0 <= f l 0.
Hypothesis solved : nearly_balanced e (finite e).
Hypothesis rate_solved : nearly_balanced e (rate c).
Hypothesis check : end_check c up x.

Let S (l : nat) : F := real (scale_of e l).
Let S0 l : 0 < S l := scale_is_positive F equilibrium_ok l.
Let a : F := real (fraction (finite e)).
Let b : F := real (fraction (rate c)).
Let a0 : 0 < a. Proof. by case/and5P: solved => _ _ t0 _ _; rewrite -(real_zero F) real_lt. Qed.
Let b0 : 0 < b. Proof. by case/and5P: rate_solved => _ _ t0 _ _; rewrite -(real_zero F) real_lt. Qed.

(** The quotients that the integers approximate. *)
Let g (l : 'I_N) : F := a * f l 0 / S l.
Let h (l : 'I_N) : F := - (b * (sign up * u l 0) / S l).
Let back (p s y : F) : 0 < p -> 0 < s -> y = p * y / s * s / p.
Proof. by move=> p0 s0; rewrite divfK ?gt_eqF // mulrC mulKf ?gt_eqF. Qed.
Let gE l : f l 0 = g l * S l / a. Proof. exact: back. Qed.
Let hE l : (sign up *: u) l 0 = - (h l * S l / b).
Proof. by rewrite mxE /h !mulNr opprK -back. Qed.

Let quotient_known p y (l : 'I_N) : encloses (e := e) p y ->
  `|real (fraction p) * y l 0 / S l - real (nth 0 (quotients p) l)| <= real (slack p).
Proof.
move=> /(_ l)/andP[low high]; rewrite ler_distl -real_minus -real_plus ler_pdivl_mulr ?ler_pdivr_mulr ?S0 //.
by rewrite ![real _ * S l]mulrC low high.
Qed.
Let g_known l : `|g l - real (quotient c l)| <= real (slack (finite e)).
Proof. exact: quotient_known. Qed.
Let h_known l : `|h l - real (fall c up l)| <= real (slack (rate c)).
Proof.
have := quotient_known l u_known; rewrite /h /fall rmorphN /= real_signed /sign -/b; case: up.
  by rewrite !mul1r -opprD normrN.
by rewrite !mulN1r mulrN mulNr !opprK.
Qed.

Let product_known (y z y' z' d d' : F) : `|y - y'| <= d -> `|z - z'| <= d' ->
  `|y * z - y' * z'| <= `|y'| * d' + `|z'| * d + d * d'.
Proof.
move=> yk zk; have -> : y * z - y' * z' = y' * (z - z') + z' * (y - y') + (y - y') * (z - z') by ring.
apply: le_trans (ler_norm_add _ _) _; apply: ler_add; last by rewrite normrM ler_pmul.
by apply: le_trans (ler_norm_add _ _) _; apply: ler_add; rewrite normrM ler_wpmul2l.
Qed.
Let products_known k l :
  `|g k * h l - real (quotient c k * fall c up l)| <= real (uncertain c (quotient c k) (fall c up l)).
Proof. by rewrite /uncertain !real_plus !real_times -!real_abs; apply: product_known. Qed.

(** A force that outlasts that of m, in the words of box_load.v. *)
Let outlasting (m l : 'I_N) : outlasts c up m l -> 0 < f m 0 * (sign up *: u) l 0 - f l 0 * (sign up *: u) m 0.
Proof.
rewrite /outlasts -(real_lt F) real_plus real_minus => enough.
have -> : f m 0 * (sign up *: u) l 0 - f l 0 * (sign up *: u) m 0 = (g l * h m - g m * h l) * (S l * S m / (a * b)).
  rewrite !gE !hE; move: (g l) (g m) (h l) (h m) (S l) (S m) a b (gt_eqF a0) (gt_eqF b0) => *; field.
  by apply/andP; split; apply/negbT.
rewrite pmulr_lgt0 ?divr_gt0 ?mulr_gt0 ?S0 // subr_gt0.
have := products_known l m; have := products_known m l; rewrite !ler_distl => /andP[_ up_ml] /andP[low_lm _].
apply: le_lt_trans up_ml _; apply: lt_le_trans low_lm.
by rewrite ltr_subr_addl addrCA -ltr_subr_addl.
Qed.

Let vanishing (m : 'I_N) (t := f m 0 / - (sign up *: u) m 0) : 0 < h m -> vanishes_between c up x m ->
  sign up * (real (near x) - real (stress c)) <= t <= sign up * (real (far x) - real (stress c)).
Proof.
move=> hm /andP[]; rewrite -!(real_le F) !(real_times, real_plus, real_minus) -!real_abs.
have aheadE s : real (ahead c up s) = sign up * (real s - real (stress c)) :> F.
  by rewrite /ahead real_signed real_minus.
rewrite !aheadE -/a -/b; set y := sign up * _; set z := sign up * _ => near_ok far_ok.
have -> : t = g m * b / (h m * a).
  rewrite /t hE opprK gE; move: (g m) (h m) (S m) a b (gt_eqF hm) (gt_eqF (S0 m)) (gt_eqF a0) (gt_eqF b0) => *; field.
  by apply/and4P; split; apply/negbT.
have ha : 0 < h m * a by apply: mulr_gt0.
have spread (d : F) : `|d * h m - d * real (fall c up m)| <= `|d| * real (slack (rate c)).
  by rewrite -mulrBr normrM ler_wpmul2l.
have := g_known m; rewrite ler_distl => /andP[low high].
have := spread y; rewrite ler_distl => /andP[_ y_high]; have := spread z; rewrite ler_distl => /andP[z_low _].
apply/andP; split.
  rewrite ler_pdivl_mulr // mulrA; apply: le_trans (ler_wpmul2r (ltW a0) y_high) _; apply: le_trans near_ok _.
  by rewrite ler_wpmul2r ?(ltW b0).
rewrite ler_pdivr_mulr // mulrA; apply: le_trans (ler_wpmul2r (ltW b0) high) _; apply: le_trans far_ok _.
by rewrite ler_wpmul2r ?(ltW a0).
Qed.

Lemma end_is_proved : is_the_end q up x.
Proof.
have signed_rate : balanced (radius F v) (contacts v) q (sign up *: load_vector F e (rate c)) (sign up *: u).
  by rewrite /balanced -scalemxAr -scalerDr rate_bal scaler0.
have free_of_rate : forall k, k \in flagged e (free x) -> (sign up *: load_vector F e (rate c)) k 0 = 0.
  by move=> k kf; case/andP: check => /(free_of_load F) zero _; rewrite mxE zero ?mulr0.
have ahead s : first up (real (stress c)) s -> 0 <= sign up * (s - real (stress c)).
  by move=> /firstE; rewrite mulrBr subr_ge0.
case/andP: check => _; rewrite /is_the_end; case: (opens x) => [m|].
  case/and5P=> counted_ok /(free_of_load F) unloaded /andP[mute_m] /norP[zm hm0] falls /andP[between others].
  have [same untouched] := counted_sets counted_ok.
  have mN : (m < N)%N.
    by apply: contraTT mute_m; rewrite -leqNgt => Nm; rewrite nth_default // (counted_size counted_ok).
  pose m' := Ordinal mN; have hm : 0 < h m'.
    have := h_known m'; rewrite ler_distl => /andP[low _]; apply: lt_le_trans low.
    by rewrite subr_gt0 real_lt.
  have m_falls : (sign up *: u) m' 0 < 0 by rewrite hE oppr_lt0 divr_gt0 ?mulr_gt0.
  have := vanishing hm between; set t := f m' 0 / _ => /andP[t_near t_far].
  have [||l lm touch|t0 until gone louder] := the_load_is_borne_up_to_its_end regular bal signed_rate pushing untouched free_of_rate _ unloaded
    _ hm0 (positive (l := m') zm hm0) m_falls (m := m').
  - by rewrite same addn1.
  - by rewrite inE.
  - apply: outlasting; have /allP := others; move=> /(_ (l : nat)); rewrite mem_iota ltn_ord => /(_ isT).
    by move: lm touch; rewrite inE /held_at => /negPf -> /negPf ->.
  have at_t : sign up * ((real (stress c) + sign up * t) - real (stress c)) = t.
    by rewrite [real _ + _]addrC addrK mulrA sign_sign mul1r.
  set end_ := real (stress c) + sign up * t in at_t *.
  have signed_end : sign up * end_ = sign up * real (stress c) + t by rewrite mulrDr mulrA sign_sign mul1r.
  have from_t y : sign up * (y - real (stress c)) <= t <-> first up y end_.
    split=> [|/firstE]; last by rewrite signed_end mulrBr ler_subl_addl.
    by move=> yt; apply/firstE; rewrite signed_end -ler_subl_addl -mulrBr.
  exists end_; split.
  - exact/from_t.
  - by apply/firstE; rewrite signed_end -ler_subr_addl -mulrBr.
  - by move=> s /ahead s0; rewrite (load_ahead up); apply: iff_trans (from_t s); apply: until.
  exists (f + t *: (sign up *: u)); first by rewrite (load_ahead up) at_t; apply: forces_follow_the_load.
  move=> l touch; have [lm|_] := eqVneq (l : nat) m.
    by rewrite (val_inj (lm : val l = val m')); apply: gone; rewrite inE.
  by rewrite /=; case: ifPn => lm; [apply: gone|apply: louder]; rewrite ?inE.
case/andP=> counted_ok /allP rising s /ahead s0; rewrite (load_ahead up).
have [same untouched] := counted_sets counted_ok.
apply: (the_load_is_borne_without_end regular bal signed_rate pushing untouched free_of_rate) => // [|l lm touch].
  by rewrite same addn0.
have := rising (l : nat); rewrite mem_iota ltn_ord => /(_ isT); move: lm touch; rewrite inE /held_at => /negPf -> /negPf -> /= rise.
have := h_known l; rewrite ler_distl => /andP[_ high].
rewrite hE oppr_gt0 pmulr_llt0 ?invr_gt0 // pmulr_llt0 ?S0 //; apply: le_lt_trans high _.
by rewrite -real_plus -(real_zero F) real_lt.
Qed.
End End.

(** The statement of the certificate, in full. *)
Definition certified : Prop := exists q : 'cV[F]_N,
  [/\ is_certified q, is_the_end q false (lower_end c), is_the_end q true (upper_end c) & pins_bear_nothing q].

Theorem equilibrium_with_its_interval : complete F -> load_check c -> certified.
Proof.
move=> full /and4P[equilibrium_ok rate_solved low high]; have solved : nearly_balanced e (finite e).
  by case/and5P: equilibrium_ok.
have [q ok] := one_equilibrium equilibrium_ok full; have [near _ [_ regular _ [f [bal alone signs]] _] _ _] := ok.
have inside := inside_the_ball equilibrium_ok ok.
have [g [gbal _ g_known]] := forces_are_found equilibrium_ok solved near inside regular.
have [u [u_bal _ u_known]] := forces_are_found equilibrium_ok rate_solved near inside regular.
have fg := alone _ gbal; rewrite {}fg in gbal g_known.
have pushing (l : 'I_N) : ~~ zero_at e l -> ~~ held_at e l -> 0 < f l 0.
  by move=> zl hl; have := signs l hl; rewrite (negPf zl) => -[].
have none (l : 'I_N) : ~~ held_at e l -> 0 <= f l 0 by move=> hl; have := signs l hl; case: ifP => [_ -> //|_ [/ltW]].
exists q; split=> //; last exact: no_pin_bears_anything.
  exact: end_is_proved equilibrium_ok regular bal u_bal g_known u_known pushing none solved rate_solved low.
exact: end_is_proved equilibrium_ok regular bal u_bal g_known u_known pushing none solved rate_solved high.
Qed.
End Correct.

Print Assumptions equilibrium_with_its_interval.
