(* What the extracted check says of a certificate and of its forgeries (../questions/forgeries.v):  test CERTIFICATE.v *)
let () =
  let _, whole = Reader.certificate Sys.argv.(1) in
  if not (Checker.load_check (Checker.genuine whole)) then (print_endline "what is genuine is refused"; exit 1);
  let accepted, refused = List.partition Checker.load_check (Checker.forged whole) in
  Printf.printf "%d refused, %d accepted\n" (List.length refused) (List.length accepted)
