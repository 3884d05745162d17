(** Statement K11 (../checker.md) for a box or a cell under dead loads: an equilibrium is a strict local minimum of the potential.

    Configurations compete in which no listed contact overlaps and held coordinates are at their places. Where the potential of the finite load does not grow, as
    only grains without finite force have moved, that of the infinitesimal loads does. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import shifted_factor max_norm contact_certificate box box_forces box_gaps.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Minimum.
Variables (F : realFieldType) (d : dimension) (n : nat) (w : F) (radius place : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Let C : F := (curvature d n contacts)%:R.
Variables (q : 'cV[F]_N) (b : F).
Let gaps := gaps w radius place contacts : 'cV[F]_N -> 'cV[F]_N.
Let A : 'M[F]_N := derivative w contacts q.
Let s (l : nat) : F := scale w radius (contact_at contacts l).

Definition potential (load p : 'cV[F]_N) : F := - \sum_k load k 0 * p k 0.

(** Every other configuration near p, without an overlap at a listed contact, costs work of the finite load, or none of
    it and work of the infinitesimal one. *)
Definition strict_minimum (load small p : 'cV[F]_N) : Prop := exists2 e, 0 < e & forall p', norm (p' - p) < e -> p' != p ->
  (forall l : 'I_N, apart d n radius place (at_ p') 0 (contact_at contacts l)) ->
  potential load p < potential load p' \/ potential load p = potential load p' /\ potential small p < potential small p'.

Hypothesis w0 : 0 < w.
Hypothesis scales : forall l, 0 < scale 1 radius (contact_at contacts l).
Hypothesis closed : gaps q = 0.
Hypothesis b0 : 0 < b.
Hypothesis inverse : forall x, b * norm x <= norm (A *m x).

Let C0 : 0 < C. Proof. by rewrite ltr0n curvature_is_positive. Qed.
Let s0 l : 0 < s l.
Proof. by rewrite /s; have := scales l; case: (contact_at _ _). Qed.

(** The potential grows by what the forces do against the gaps, to first order. *)
Lemma potential_grows_by_work load f p : balanced radius contacts q load f ->
  potential load p - potential load q = \sum_l f l 0 / s l * (A *m (p - q)) l 0.
Proof.
move=> bal; pose M := normals radius contacts q; pose h := p - q.
have AM : A = diag_mx (\row_l s l) *m M.
  by apply: derivative_scales; rewrite ?gt_eqF // => l; rewrite gt_eqF.
have -> : potential load p - potential load q = - dot load h.
  rewrite /potential /dot opprK addrC -sumrB -sumrN; apply: eq_bigr => k _; rewrite !mxE.
  by move: (load k 0) (p k 0) (q k 0) => *; ring.
have -> : - dot load h = dot (M^T *m f) h.
  have -> : load = - (M^T *m f) by apply/eqP; rewrite -addr_eq0 addrC; apply/eqP.
  by rewrite -scaleN1r dot_scale mulN1r opprK.
rewrite dot_transpose trmxK; apply: eq_bigr => l _.
have -> : (A *m h) l 0 = s l * (M *m h) l 0 by rewrite AM -mulmxA mul_diag_mx [LHS]mxE [X in X * _]mxE.
by rewrite mulrA divfK // gt_eqF.
Qed.

(** Nearer than this the second order of the gaps does not matter. *)
Definition reach (S : {set 'I_N}) (f : 'cV[F]_N) : F :=
  (C / b + \sum_(l in S) C * (\sum_(k in S) f k 0 / s k) / (b * (f l 0 / s l)))^-1.

Section Growth.
Variables (S : {set 'I_N}) (load f : 'cV[F]_N).
Hypothesis bal : balanced radius contacts q load f.
Hypothesis pushing : forall l, l \in S -> 0 < f l 0.
Let h l := f l 0 / s l.
Let H := \sum_(k in S) h k.
Let h0 l : l \in S -> 0 < h l. Proof. by move=> lS; rewrite divr_gt0 ?pushing. Qed.
Let H0 : 0 <= H. Proof. by apply: sumr_ge0 => l /h0/ltW. Qed.
Let terms l : l \in S -> 0 <= C * H / (b * h l).
Proof. by move=> lS; apply: divr_ge0; [rewrite mulr_ge0 // ltW|rewrite ltW // mulr_gt0 ?h0]. Qed.
Let first : 0 < C / b. Proof. exact: divr_gt0. Qed.

Lemma reach_is_positive : 0 < reach S f.
Proof. by rewrite invr_gt0 ltr_paddr // sumr_ge0. Qed.

Lemma potential_grows p : norm (p - q) < reach S f ->
  (forall l, l \in S -> 0 <= gaps p l 0) -> (forall l, l \notin S -> f l 0 * (A *m (p - q)) l 0 = 0) ->
  (exists2 l, l \in S & b / 2%:R * norm (p - q) < `|(A *m (p - q)) l 0|) -> potential load q < potential load p.
Proof.
set t := norm (p - q) => near free rest [l0 l0S far]; pose y := A *m (p - q).
have t0 : 0 < t.
  rewrite lt_neqAle norm_ge0 andbT; apply: contraTneq far => t0.
  by rewrite -t0 mulr0 (norm_eq0 (esym t0)) mulmx0 mxE normr0 ltxx.
have low l : l \in S -> - (C / 2%:R * t ^+ 2) <= y l 0.
  move=> /free open; pose z := derivative w contacts (2%:R^-1 *: (p + q)) *m (p - q).
  have gz : gaps p = z by rewrite /z -(gaps_at_the_middle w radius place) -/gaps closed subr0.
  have mid : 2%:R^-1 *: (p + q) - q = 2%:R^-1 *: (p - q).
    by apply/colP=> k; rewrite !mxE; move: (p k 0) (q k 0) => *; field.
  have := derivative_is_lipschitz w contacts (2%:R^-1 *: (p + q)) q (p - q).
  rewrite mid norm_scale ger0_norm ?invr_ge0 ?ler0n // -/t -/z -/A -/y.
  rewrite -/C; have -> : C * (2%:R^-1 * t) * t = C / 2%:R * t ^+ 2 by field.
  move=> /(le_trans (entry_norm (z - y) l)); rewrite ler_norml => /andP[_ up].
  have split : (z - y) l 0 = z l 0 - y l 0 by rewrite [LHS]mxE [X in _ + X]mxE.
  by rewrite ler_oppl; apply: le_trans up; rewrite split ler_addr -gz.
have small : t * (C / b + \sum_(l in S) C * H / (b * h l)) < 1.
  by move: near; rewrite -[reach S f]mul1r ltr_pdivl_mulr // ltr_paddr // sumr_ge0.
have tb : C * t <= b.
  rewrite -[b]mul1r -ler_pdivr_mulr //; apply: le_trans _ (ltW small).
  by rewrite -mulrA mulrC -mulrA [_^-1 * _]mulrC ler_wpmul2l ?(ltW t0) // ler_addl sumr_ge0.
have th : C * t * H < b * h l0.
  rewrite -[b * _]mul1r -ltr_pdivr_mulr ?(mulr_gt0 b0 (h0 l0S)) //.
  apply: le_lt_trans _ small.
  have -> : C * t * H / (b * h l0) = t * (C * H / (b * h l0)) by rewrite -!mulrA mulrCA.
  rewrite ler_wpmul2l ?(ltW t0) // (bigD1 l0) //= addrCA ler_addl addr_ge0 ?(ltW first) // sumr_ge0 // => l /andP[lS _].
  exact: terms.
have up : b / 2%:R * t < y l0 0.
  move: far; rewrite -/y; case: (ger0P (y l0 0)) => // neg; rewrite ltNge => /negP[].
  rewrite ler_oppl; apply: le_trans (low _ l0S); rewrite ler_opp2.
  have -> : C / 2%:R * t ^+ 2 = C * t / 2%:R * t by field.
  by rewrite ler_wpmul2r ?(ltW t0) // ler_wpmul2r ?invr_ge0 ?ler0n.
rewrite -subr_gt0 (potential_grows_by_work _ bal) -/y.
have -> : \sum_l f l 0 / s l * y l 0 = \sum_(l in S) h l * y l 0.
  rewrite [RHS]big_mkcond; apply: eq_bigr => l _; case: ifPn => // /rest zero.
  by rewrite mulrAC zero mul0r.
have -> : \sum_(l in S) h l * y l 0 = \sum_(l in S) h l * (y l 0 + C / 2%:R * t ^+ 2) - C / 2%:R * t ^+ 2 * H.
  by rewrite /H mulr_sumr -sumrB; apply: eq_bigr => l _; rewrite mulrDr [C / 2%:R * _ * _]mulrC addrK.
rewrite subr_gt0 (bigD1 l0) //=; apply: lt_le_trans (_ : h l0 * (y l0 0) <= _); last first.
  apply: le_trans (_ : h l0 * (y l0 0 + C / 2%:R * t ^+ 2) <= _).
    by rewrite ler_wpmul2l ?(ltW (h0 l0S)) // ler_addl mulr_ge0 ?sqr_ge0 ?divr_ge0 ?ler0n ?(ltW C0).
  rewrite ler_addl sumr_ge0 // => l /andP[lS _]; rewrite mulr_ge0 ?(ltW (h0 lS)) //.
  by rewrite -ler_subl_addr sub0r low.
apply: lt_trans (_ : h l0 * (b / 2%:R * t) < _); last by rewrite ltr_pmul2l ?h0.
have -> : C / 2%:R * t ^+ 2 * H = C * t * H * (t / 2%:R) by field.
have -> : h l0 * (b / 2%:R * t) = b * h l0 * (t / 2%:R) by field.
by rewrite ltr_pmul2r ?divr_gt0 ?ltr0n.
Qed.
End Growth.

(** Without finite force: [zeros]. Without load, and touched by no other contact: [free]. *)
Variables (zeros free : {set 'I_N}) (load f small g : 'cV[F]_N).
Hypothesis same : #|free| = #|zeros|.
Hypothesis unloaded : forall k, k \in free -> load k 0 = 0.
Hypothesis untouched : forall k l : 'I_N, k \in free -> l \notin zeros -> (k : nat) \notin coordinates d n (contact_at contacts l).
Hypothesis balance : balanced radius contacts q load f.
Hypothesis small_balance : balanced radius contacts q small g.
Hypothesis no_force : forall l, l \in zeros -> f l 0 = 0.
Hypothesis force : forall l, l \notin zeros -> ~~ holds (contact_at contacts l) -> 0 < f l 0.
Hypothesis zeros_touch : forall l, l \in zeros -> ~~ holds (contact_at contacts l).
Hypothesis small_force : forall l, l \in zeros -> 0 < g l 0.

Let A_zero (k l : 'I_N) : k \in free -> l \notin zeros -> A l k = 0.
Proof.
move=> kf lz; rewrite mxE big1_seq // => e /andP[/eqP e1 es]; case/negP: (untouched kf lz).
by rewrite -e1 -(gradient_coordinates d n w (at_ q)) map_f.
Qed.

(** The vertex with those coordinates of p that are not free. *)
Let without (p : 'cV[F]_N) : 'cV[F]_N := \col_k (if k \in free then q k 0 else p k 0).

Let same_gaps p l : l \notin zeros -> gaps (without p) l 0 = gaps p l 0.
Proof.
move=> lz; rewrite !mxE; congr (_ * _); apply: doubled_gap_depends => k touched.
rewrite /at_; apply: eq_bigr => m /eqP mk; rewrite mxE; case: ifP => // /untouched/(_ lz).
by rewrite mk touched.
Qed.

Let same_potential p : potential load (without p) = potential load p.
Proof.
congr (- _); apply: eq_bigr => k _; rewrite mxE; case: ifP => // kf.
by rewrite unloaded // !mul0r.
Qed.

Let nearer p : norm (without p - q) <= norm (p - q).
Proof.
apply: norm_le => [|k]; first exact: norm_ge0.
have := entry_norm (p - q) k; rewrite !mxE; case: ifP => // _ _.
by rewrite subrr normr0 norm_ge0.
Qed.

(** If y bounds A h on S alone, and nothing else of A h counts for h, then some entry of S is not small. *)
Let some_entry (S : {set 'I_N}) (h u : 'cV[F]_N) : h != 0 -> norm h <= norm (invmx A *m u) -> A \in unitmx ->
  (forall l, l \notin S -> u l 0 = 0) -> exists2 l, l \in S & b / 2%:R * norm h < `|u l 0|.
Proof.
move=> nz bound unit outside; have [/existsP[l /andP[lS far]]|/existsPn none] :=
  boolP [exists l, (l \in S) && (b / 2%:R * norm h < `|u l 0|)]; first by exists l.
have half0 : 0 <= b / 2%:R * norm h by rewrite !mulr_ge0 ?invr_ge0 ?ler0n ?norm_ge0 // ltW.
have : b * norm h <= b / 2%:R * norm h.
  apply: le_trans (_ : norm u <= _); last first.
    apply: norm_le => // l; have := none l; case lS: (l \in S) => /=; first by rewrite -leNgt.
    by rewrite outside ?lS ?normr0.
  have := inverse (invmx A *m u); rewrite mulKVmx //; apply: le_trans.
  by rewrite ler_pmul2l.
rewrite -mulrA ler_pmul2l // mulrC -subr_le0 -[X in X - _]mulr1 -mulrBr => le0.
case/negP: nz; apply/eqP/norm_eq0/eqP; rewrite eq_le norm_ge0 andbT.
have half1 : 0 < 1 - 2%:R^-1 :> F by rewrite subr_gt0 invf_lt1 ?ltr0n // ltr1n.
by rewrite -(pmulr_lle0 _ half1).
Qed.

(** Contacts that bear a finite force. *)
Let bearing : {set 'I_N} := [set l | (l \notin zeros) && ~~ holds (contact_at contacts l)].

(** A row that holds a coordinate sees no displacement. *)
Let held_row p (l : 'I_N) : holds (contact_at contacts l) -> gaps p l 0 = 0 -> (A *m (p - q)) l 0 = 0.
Proof.
move=> held zero; have : gaps p l 0 - gaps q l 0 = 0 by rewrite zero closed mxE subrr.
rewrite -[X in X = 0 -> _](_ : (gaps p - gaps q) l 0 = _); last by rewrite mxE [X in _ + X]mxE.
rewrite /gaps gaps_at_the_middle !derivative_entry; move: held.
by case: (contact_at contacts l).
Qed.

Let difference (x y : 'cV[F]_N) k : (x - y) k 0 = x k 0 - y k 0.
Proof. by rewrite !mxE. Qed.

Hypothesis regular : A \in unitmx.

Theorem equilibrium_is_a_strict_minimum : strict_minimum load small q.
Proof.
have force' l : l \in bearing -> 0 < f l 0 by rewrite inE => /andP[/force].
exists (Num.min (reach bearing f) (reach zeros g)).
  by rewrite lt_minr !reach_is_positive.
move=> p; rewrite lt_minr => /andP[near near_small] pq free_of_overlap.
have open l : 0 <= gaps p l 0.
  rewrite mxE mulr_ge0 ?invr_ge0 ?ler0n //; have := free_of_overlap l.
  case: (contact_at _ _) => [i j k k' m|i a|i a|k] /=; rewrite ?distance_by_separations ?addr0 ?subr_ge0 -?expr2 //.
  - by move=> low; rewrite mulr_ge0 ?subr_ge0 // addr_ge0 // ltW.
  - by move=> low; rewrite mulr_ge0 ?subr_ge0 ?ler_subr_addl // addr_ge0 // ltW.
  by move=> ->; rewrite subrr mulr0.
have stay (l : 'I_N) : holds (contact_at contacts l) -> gaps p l 0 = 0.
  by rewrite mxE; have := free_of_overlap l; case: (contact_at _ _) => //= k -> _; rewrite subrr !mulr0.
have [stays|moves] := eqVneq (without p) q.
  have fixed k : k \notin free -> (p - q) k 0 = 0.
    move=> kf; have := congr1 (fun x : 'cV[F]_N => x k 0) stays; rewrite /= mxE (negPf kf) => pk.
    by rewrite !mxE pk subrr.
  right; split; first by rewrite -(same_potential p) stays.
  apply: (potential_grows small_balance small_force near_small) => [l _|l lz|]; first exact: open.
    rewrite mxE big1 ?mulr0 // => k _; case kf: (k \in free); first by rewrite A_zero ?mul0r.
    by rewrite fixed ?kf ?mulr0.
  apply: some_entry => //; rewrite ?subr_eq0 ?mulKmx // => l lz.
  rewrite mxE big1 // => k _; case kf: (k \in free); first by rewrite A_zero ?mul0r.
  by rewrite fixed ?kf ?mulr0.
left; rewrite -(same_potential p).
apply: (potential_grows balance force' (le_lt_trans (nearer p) near)) => [l|l|].
- by rewrite inE => /andP[lz _]; rewrite same_gaps.
- rewrite inE negb_and !negbK; have [/no_force -> _|lz /= held] := boolP (l \in zeros); first by rewrite mul0r.
  by rewrite held_row ?mulr0 // same_gaps ?stay.
pose y := A *m (without p - q); pose u : 'cV[F]_N := \col_l (if l \in zeros then 0 else y l 0).
have [l lS far] : exists2 l, l \in bearing & b / 2%:R * norm (without p - q) < `|u l 0|.
  apply: some_entry => //; first by rewrite subr_eq0.
    have z_is k : k \in ~: free -> (invmx A *m u - (without p - q)) k 0 = 0.
      apply: (block_solutions_vanish regular (S := ~: zeros)) => [i j||i].
      - by rewrite !inE negbK => iz jf; apply: A_zero.
      - by rewrite [LHS]cardsCs [RHS]cardsCs !setCK same.
      by rewrite inE => iz; rewrite mulmxBr mulKVmx // -/y mxE [X in _ + X]mxE mxE (negPf iz) subrr.
    apply: norm_le => [|k]; first exact: norm_ge0.
    case kf: (k \in free); first by rewrite !mxE kf subrr normr0 norm_ge0.
    have := z_is k; rewrite inE kf => /(_ isT); rewrite difference => /eqP.
    rewrite subr_eq0 => /eqP <-.
    exact: entry_norm.
  move=> l; rewrite inE negb_and !negbK mxE; case: ifP => //= lz held.
  by rewrite /y held_row // same_gaps ?lz ?stay.
by exists l => //; move: far; rewrite mxE; move: lS; rewrite inE => /andP[/negPf ->].
Qed.
End Minimum.

Print Assumptions potential_grows_by_work.
Print Assumptions equilibrium_is_a_strict_minimum.
