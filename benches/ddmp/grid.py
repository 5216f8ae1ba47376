"""Quadratic triangles with material points: mesh, shape functions, fitted weights, Hencky elasticity."""
import os
os.environ.setdefault('OMP_NUM_THREADS','1'); os.environ.setdefault('OPENBLAS_NUM_THREADS','1')
import numpy as np, scipy.sparse as sp, scipy.sparse.linalg as spl
from scipy.spatial import Delaunay
import numba as nb

def dunavant12():
    P=[];W=[]
    for w,a in ((0.116786275726379,0.249286745170910),(0.050844906370207,0.063089014491502)):
        b=1-2*a
        for q in ([b,a,a],[a,b,a],[a,a,b]): P.append(q);W.append(w)
    w,a,b=0.082851075618374,0.310352451033785,0.053145049844816; c=1-a-b
    import itertools
    for q in itertools.permutations((a,b,c)): P.append(list(q));W.append(w)
    W=np.array(W); return np.array(P),W/W.sum()
def seeds(k):
    if k==12: return dunavant12()
    if k in(3,6):
        if k==3: return np.array([[2/3,1/6,1/6],[1/6,2/3,1/6],[1/6,1/6,2/3]]),np.ones(3)/3
        a,b=0.445948490915965,0.091576213509771
        P=[[1-2*a,a,a],[a,1-2*a,a],[a,a,1-2*a],[1-2*b,b,b],[b,1-2*b,b],[b,b,1-2*b]]
        W=np.array([0.223381589678011]*3+[0.109951743655322]*3); return np.array(P),W/W.sum()
    n=int(round(np.sqrt(k))); P=[]
    for i in range(n):
        for j in range(n-i):
            P.append([(i+1/3)/n,(j+1/3)/n])
            if j<n-i-1: P.append([(i+2/3)/n,(j+2/3)/n])
    P=np.array(P); return np.c_[P,1-P.sum(1)],np.ones(len(P))/len(P)

class Mesh:
    def __init__(s,xs,ys,jit=0.2,seed=1,xl=(),yl=()):
        """tensor grid jittered; xl,yl: extra lines kept straight"""
        rng=np.random.default_rng(seed)
        xs=np.asarray(xs,float); ys=np.asarray(ys,float); nx,ny=len(xs),len(ys)
        X=np.array([[x,y] for y in ys for x in xs]); h=ys[1]-ys[0]; hx=xs[1]-xs[0]
        d=rng.uniform(-1,1,X.shape)*jit*np.array([hx,h])
        fx=np.zeros(len(X),bool); fy=np.zeros(len(X),bool)
        for v in (xs[0],xs[-1],*xl): fx|=abs(X[:,0]-v)<1e-9
        for v in (ys[0],ys[-1],*yl): fy|=abs(X[:,1]-v)<1e-9
        d[fx,0]=0; d[fy,1]=0; X=X+d
        s.h=h; D=Delaunay(X); T=D.simplices.copy(); s.D=D
        a=0.5*((X[T[:,1],0]-X[T[:,0],0])*(X[T[:,2],1]-X[T[:,0],1])-(X[T[:,2],0]-X[T[:,0],0])*(X[T[:,1],1]-X[T[:,0],1]))
        neg=a<0; T[neg]=T[neg][:,[0,2,1]]; a=abs(a); assert a.min()>1e-3*h*h,a.min()
        s.nv=len(X); s.ne=len(T); s.A=a
        edges={}; X6=list(X); T6=[]; inc={}
        for e,t in enumerate(T):
            row=list(t)
            for (i,j) in ((0,1),(1,2),(2,0)):
                k=(min(t[i],t[j]),max(t[i],t[j]))
                if k not in edges: edges[k]=len(X6); X6.append(.5*(X[k[0]]+X[k[1]]))
                row.append(edges[k]); inc.setdefault(k,[]).append(e)
            T6.append(row)
        s.X=np.array(X6); s.T=np.array(T6); s.nn=len(s.X)
        A1=np.concatenate([np.ones((s.ne,3,1)),s.X[s.T[:,:3]]],2); inv=np.linalg.inv(A1)
        s.gL=np.swapaxes(inv[:,1:,:],1,2).copy()  # (ne,3,2)
        s.L0=inv[:,0,:].copy()                     # L = L0 + gL x
        s.cent=s.X[s.T[:,:3]].mean(1); s.sc=np.sqrt(s.A)
        s.faces=[(k,v) for k,v in inc.items() if len(v)==2]
        s.fe=np.array([v for k,v in s.faces]); s.fk=np.array([k for k,v in s.faces])
        nbr=-np.ones((s.ne,3),int); cnt=np.zeros(s.ne,int)
        for a_,b_ in s.fe: nbr[a_,cnt[a_]]=b_;cnt[a_]+=1; nbr[b_,cnt[b_]]=a_;cnt[b_]+=1
        s.nbr=nbr
        s._ghost(); s._dd()
        s.sub=np.array([[0,3,5],[3,1,4],[5,4,2],[3,4,5]])
    def dN(s,el,L):
        g=s.gL[el]; l1,l2,l3=L.T
        o=np.zeros((len(el),6,3)); o[:,0,0]=4*l1-1;o[:,1,1]=4*l2-1;o[:,2,2]=4*l3-1
        o[:,3,0]=4*l2;o[:,3,1]=4*l1;o[:,4,1]=4*l3;o[:,4,2]=4*l2;o[:,5,0]=4*l3;o[:,5,2]=4*l1
        return o@g
    def N(s,L):
        l1,l2,l3=L.T; return np.stack([l1*(2*l1-1),l2*(2*l2-1),l3*(2*l3-1),4*l1*l2,4*l2*l3,4*l3*l1],1)
    def locate(s,x):
        lo=s.X.min(0);hi=s.X.max(0); xc=np.clip(x,lo+1e-10,hi-1e-10)
        e=s.D.find_simplex(xc,tol=1e-9)
        if (e<0).any():
            for i in np.where(e<0)[0]:
                Li=s.L0+s.gL@xc[i]; e[i]=Li.min(1).argmax()
        L=s.L0[e]+np.einsum('pij,pj->pi',s.gL[e],xc)
        return e,L
    def _ghost(s):
        nf=len(s.faces); s.g1=np.zeros((nf,12,12)); s.g2=np.zeros((nf,12,12)); s.gn=np.zeros((nf,12),int); s.gl=np.zeros(nf)
        q=np.array([.5-.5/np.sqrt(3),.5+.5/np.sqrt(3)])
        for f,(k,v) in enumerate(s.faces):
            xa,xb=s.X[k[0]],s.X[k[1]]; t=xb-xa; ln=np.hypot(*t); n=np.array([t[1],-t[0]])/ln; s.gl[f]=ln
            s.gn[f]=np.r_[s.T[v[0]],s.T[v[1]]]
            for z in q:
                x=xa+z*t; j=[]
                for sg,e in ((1,v[0]),(-1,v[1])):
                    L=s.L0[e]+s.gL[e]@x; j.append(sg*(s.dN(np.array([e]),L[None])[0]@n))
                j=np.concatenate(j); s.g1[f]+=ln/2*np.outer(j,j)*s.h
            j=[]
            for sg,e in ((1,v[0]),(-1,v[1])):
                a=s.gL[e]@n
                j.append(sg*np.array([4*a[0]**2,4*a[1]**2,4*a[2]**2,8*a[0]*a[1],8*a[1]*a[2],8*a[2]*a[0]]))
            j=np.concatenate(j); s.g2[f]+=ln*np.outer(j,j)*s.h**3
    def _dd(s):
        # per cell per vertex: int L_a grad N
        s.Gc=np.zeros((s.ne,3,6,2)); I=np.eye(3); al=np.arange(s.ne)
        d=[s.dN(al,np.tile(I[b],(s.ne,1))) for b in range(3)]
        for a in range(3): s.Gc[:,a]=sum(d[b]*(2 if a==b else 1) for b in range(3))*(s.A/12)[:,None,None]
    def ops(s,el,L,scheme='plain',active=None):
        """sparse Bx,By (np x nn)"""
        n=len(el); g=s.dN(el,L); r=np.repeat(np.arange(n),6); c=s.T[el].ravel()
        if scheme!='ddmp': return [sp.csr_matrix((g[:,:,d].ravel(),(r,c)),shape=(n,s.nn)) for d in(0,1)]
        a=27*L.prod(1); a=np.clip(a,0,1)
        ac=np.where(active)[0]; W=np.zeros(s.nv); np.add.at(W,s.T[ac,:3],np.repeat(s.A[ac,None]/3,3,1)); W[W==0]=1
        rr=np.repeat(s.T[ac,:3],6,axis=1).ravel(); cc=np.tile(s.T[ac],(1,3)).ravel()
        H=sp.csr_matrix((L.ravel(),(np.repeat(np.arange(n),3),s.T[el,:3].ravel())),shape=(n,s.nv))
        out=[]
        for d in (0,1):
            G=sp.csr_matrix((s.Gc[ac,:,:,d].ravel(),(rr,cc)),shape=(s.nv,s.nn)); G=sp.diags(1/W)@G
            B=sp.csr_matrix((g[:,:,d].ravel(),(r,c)),shape=(n,s.nn))
            out.append((sp.diags(a)@B+sp.diags(1-a)@(H@G)).tocsr())
        return out

@nb.njit(cache=True)
def _tri_mom(x,cx,cy,sc,out):
    A=0.5*((x[1,0]-x[0,0])*(x[2,1]-x[0,1])-(x[2,0]-x[0,0])*(x[1,1]-x[0,1]))
    for k in range(3):
        j=(k+1)%3
        a=(0.5*(x[k,0]+x[j,0])-cx)/sc; b=(0.5*(x[k,1]+x[j,1])-cy)/sc; w=A/3
        out[0]+=w;out[1]+=w*a;out[2]+=w*b;out[3]+=w*a*a;out[4]+=w*a*b;out[5]+=w*b*b
@nb.njit(cache=True)
def _clip(x,v,poly):
    n=0
    for i in range(3):
        j=(i+1)%3
        if v[i]>0: poly[n]=x[i]; n+=1
        if (v[i]>0)!=(v[j]>0):
            t=v[i]/(v[i]-v[j]); poly[n,0]=x[i,0]+t*(x[j,0]-x[i,0]); poly[n,1]=x[i,1]+t*(x[j,1]-x[i,1]); n+=1
    return n
@nb.njit(cache=True)
def moments(X,T,sub,phi,owner,cent,sc):
    ne=T.shape[0]; M=np.zeros((ne,6)); vol=np.zeros(ne); poly=np.zeros((6,2)); x=np.zeros((3,2)); v=np.zeros(3); tr=np.zeros((3,2)); o6=np.zeros(6)
    for e in range(ne):
        o=owner[e]
        oo=e if o<0 else o
        o6[:]=0
        for q in range(4):
            for k in range(3):
                x[k]=X[T[e,sub[q,k]]]; v[k]=phi[T[e,sub[q,k]]]
            n=_clip(x,v,poly)
            for k in range(1,n-1):
                tr[0]=poly[0];tr[1]=poly[k];tr[2]=poly[k+1]
                _tri_mom(tr,cent[oo,0],cent[oo,1],sc[oo],o6)
        vol[e]=o6[0]
        if o>=0: M[o]+=o6
    return M,vol
@nb.njit(cache=True)
def _fit(C,V,d,q,lo,hi,eps,scale):
    """C (6,k); returns ok, w ; min sum (w-V)^2/V st C[:q]w=d[:q] (row j relaxed by eps[j]) lo V<=w<=hi V. scale=volume scale"""
    k=V.shape[0]; lam=np.zeros(q); w=V.copy(); g=np.zeros(q); J=np.zeros((q,q))
    tol=1e-11*scale
    phi_old=1e300
    for it in range(60):
        for i in range(q):
            g[i]=-d[i]+eps[i]*scale*lam[i]
            for j in range(q): J[i,j]=0
            J[i,i]=eps[i]*scale
        for p in range(k):
            t=0.
            for i in range(q): t+=C[i,p]*lam[i]
            f=1+t; fr=True
            if f<lo: f=lo; fr=False
            elif f>hi: f=hi; fr=False
            w[p]=V[p]*f
            for i in range(q):
                g[i]+=C[i,p]*w[p]
                if fr:
                    for j in range(q): J[i,j]+=V[p]*C[i,p]*C[j,p]
        m=0.
        for i in range(q): m=max(m,abs(g[i]))
        if m<tol: return True,w,it
        if it==0:
            # rank check
            ev=np.linalg.eigvalsh(J)
            if ev[0]<1e-11*ev[-1]: return False,w,it
        for i in range(q): J[i,i]+=1e-10*scale
        dl=np.linalg.solve(J,-g)
        if np.abs(dl).max()>1e8: return False,w,it
        # line search on the convex dual
        s0=0.
        for i in range(q): s0+=g[i]*dl[i]
        a=1.
        P0=0.
        for ls in range(30):
            P=0.
            lam2=lam+(a*dl if ls>0 or it>=0 else dl)
            if ls==0:
                P0=0.
                for p in range(k):
                    t=0.
                    for i in range(q): t+=C[i,p]*lam[i]
                    P0+=V[p]*_psi(t,lo,hi)
                for i in range(q): P0+=-d[i]*lam[i]+0.5*eps[i]*scale*lam[i]**2
            for p in range(k):
                t=0.
                for i in range(q): t+=C[i,p]*lam2[i]
                P+=V[p]*_psi(t,lo,hi)
            for i in range(q): P+=-d[i]*lam2[i]+0.5*eps[i]*scale*lam2[i]**2
            if P<=P0+1e-4*a*s0+1e-14*scale: break
            a*=0.5
        lam=lam+a*dl
    return False,w,60
@nb.njit(cache=True)
def _psi(t,lo,hi):
    # integral of clip(1+t,lo,hi)
    if 1+t<lo: t0=lo-1; return t0+0.5*t0*t0+lo*(t-t0)
    if 1+t>hi: t0=hi-1; return t0+0.5*t0*t0+hi*(t-t0)
    return t+0.5*t*t
@nb.njit(cache=True)
def fit_all(order,start,xp,V,cent,sc,A,M,do,maxq,lo,hi,soft):
    """per cell fit. do[e]: 1 fit, 0 leave. returns w, deg (6,5=soft,3,1,0=V_p)"""
    ne=M.shape[0]; w=V.copy(); deg=np.zeros(ne,np.int64); mn=np.zeros(ne)
    e0=np.zeros(6); es=np.zeros(6); es[3:]=1e-6; es1=np.zeros(6); es1[1:]=1e-6
    for e in range(ne):
        a,b=start[e],start[e+1]; k=b-a
        if k==0 or do[e]==0: continue
        C=np.ones((6,k)); Vk=np.zeros(k)
        for i in range(k):
            p=order[a+i]; Vk[i]=V[p]; x=(xp[p,0]-cent[e,0])/sc[e]; y=(xp[p,1]-cent[e,1])/sc[e]
            C[1,i]=x;C[2,i]=y;C[3,i]=x*x;C[4,i]=x*y;C[5,i]=y*y
        s=max(M[e,0],1e-12*A[e])
        # start from volume-scaled V so that bounds are relative to the mean need
        Vk2=Vk*(s/Vk.sum())
        for lev in range(5):
            q=6 if lev<2 else (3 if lev<4 else 1)
            if (lev==1 or lev==3) and soft==0: continue
            if q>maxq: continue
            if lev==0 or lev==2 or lev==4:
                if k<q: continue
                ok,ww,it=_fit(C,Vk2,M[e],q,lo,hi,e0,s)
            elif lev==1: ok,ww,it=_fit(C,Vk2,M[e],q,lo,hi,es,s)
            else: ok,ww,it=_fit(C,Vk2,M[e],q,lo,hi,es1,s)
            if ok:
                for i in range(k): w[order[a+i]]=ww[i]
                deg[e]=5 if lev==1 else (2 if lev==3 else q); break
    return w,deg

@nb.njit(cache=True)
def fillfrac(X,T,sub,el,L,V,nn,smooth):
    m=np.zeros(nn); W=np.zeros(nn)
    for e in range(T.shape[0]):
        for q in range(4):
            a=X[T[e,sub[q,0]]];b=X[T[e,sub[q,1]]];c=X[T[e,sub[q,2]]]
            A=0.5*((b[0]-a[0])*(c[1]-a[1])-(c[0]-a[0])*(b[1]-a[1]))
            for k in range(3): W[T[e,sub[q,k]]]+=A/3
    l=np.zeros(3)
    for p in range(el.shape[0]):
        L1,L2,L3=L[p,0],L[p,1],L[p,2]; t=T[el[p]]
        if L1>=.5: q=0; l[0]=2*L1-1;l[1]=2*L2;l[2]=2*L3
        elif L2>=.5: q=1; l[0]=2*L1;l[1]=2*L2-1;l[2]=2*L3
        elif L3>=.5: q=2; l[0]=2*L1;l[1]=2*L2;l[2]=2*L3-1
        else: q=3; l[0]=1-2*L3;l[1]=1-2*L1;l[2]=1-2*L2
        for k in range(3): m[t[sub[q,k]]]+=V[p]*l[k]
    phi=m/W
    for it in range(smooth):
        a2=np.zeros(nn)
        for e in range(T.shape[0]):
            for q in range(4):
                a=X[T[e,sub[q,0]]];b=X[T[e,sub[q,1]]];c=X[T[e,sub[q,2]]]
                A=0.5*((b[0]-a[0])*(c[1]-a[1])-(c[0]-a[0])*(b[1]-a[1]))
                av=(phi[T[e,sub[q,0]]]+phi[T[e,sub[q,1]]]+phi[T[e,sub[q,2]]])/3
                for k in range(3): a2[T[e,sub[q,k]]]+=A/3*av
        phi=a2/W
    return phi
def level(mesh,phi,Vtot,own):
    lo,hi=0.05,0.98
    f=lambda c: moments(mesh.X,mesh.T,mesh.sub,phi-c,own,mesh.cent,mesh.sc)[1].sum()-Vtot
    for _ in range(22):
        c=.5*(lo+hi)
        if f(c)>0: lo=c
        else: hi=c
    return c
def csr_cells(el,ne):
    order=np.argsort(el,kind='stable'); start=np.zeros(ne+1,np.int64); start[1:]=np.cumsum(np.bincount(el,minlength=ne)); return order,start

def hencky(F,Lam,G):
    b=np.einsum('pij,pkj->pik',F,F); m=.5*(b[:,0,0]+b[:,1,1]); d=.5*(b[:,0,0]-b[:,1,1]); r=np.hypot(d,b[:,0,1])
    l1=m+r; det=b[:,0,0]*b[:,1,1]-b[:,0,1]**2; l2=det/l1; th=.5*np.arctan2(b[:,0,1],d); c,s=np.cos(th),np.sin(th)
    e1,e2=.5*np.log(l1),.5*np.log(l2); t1=(Lam+2*G)*e1+Lam*e2; t2=(Lam+2*G)*e2+Lam*e1
    dl=l1-l2; k=np.where(dl>1e-10*l1,G*np.log1p(dl/l2)/np.where(dl>0,dl,1),G/l2)
    n=len(F); Q=np.empty((n,2,2)); Q[:,0,0]=c;Q[:,0,1]=-s;Q[:,1,0]=s;Q[:,1,1]=c
    tau=np.einsum('pia,pa,pja->pij',Q,np.stack([t1,t2],1),Q)
    a=np.zeros((n,4,4)) # 11,12,21,22
    a[:,0,0]=Lam+2*G-t1;a[:,3,3]=Lam+2*G-t2;a[:,0,3]=a[:,3,0]=Lam
    a[:,1,1]=k*l2;a[:,1,2]=k*l1-t1;a[:,2,2]=k*l1;a[:,2,1]=k*l2-t2
    R=np.einsum('pia,pjb->pijab',Q,Q).reshape(n,4,4)
    return tau,R@a@np.swapaxes(R,1,2)
